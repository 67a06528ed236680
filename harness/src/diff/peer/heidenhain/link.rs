//! Telegrams between controller computers.

use stillpoint_monitors::heidenhain::cc_link;
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::mutant::Mutant;

use super::numbers::*;
use crate::diff::peer::adapter::{Adapter, cells};
use crate::diff::peer::{Made, Params, Refusable, chosen};

/// The monitor of a machine of this topic.
pub(super) fn make(machine: &str, p: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "cc_link" => cc_link(p, mutant)?,
        _ => return Ok(None),
    }))
}

cells! {
    cc_link::State, 3 {
        faulty = small, i32::from;
        last = drive, bits;
        lost = truthy, i32::from;
    }
}

/// A drive from the five bits that the table has of it.
fn drive(bits: i32) -> cc_link::Drive {
    let has = |bit: i32| bits & (1 << bit) != 0;
    cc_link::Drive {
        moving: has(0),
        group: has(1).then_some(0),
        position: Position(i32::from(has(2))),
        brake_open: has(3),
        torque: has(4),
    }
}

fn bits(drive: cc_link::Drive) -> i32 {
    let all = [
        drive.moving,
        drive.group.is_some(),
        drive.position != Position(0),
        drive.brake_open,
        drive.torque,
    ];
    let each = all.iter().zip(0..).map(|(set, bit)| i32::from(*set) << bit);
    each.sum()
}

fn cc_link(p: &Params, mutant: Option<Mutant>) -> Refusable {
    let config = cc_link::Config::new(small(p.value("tolerated")))?;
    let next = chosen::<cc_link::Monitor>(mutant);
    Ok(Adapter::new(
        &[
            "main_switch",
            "sound",
            "fatal",
            "moves",
            "member",
            "place",
            "brake_open",
            "torque",
        ],
        &[
            "demand",
            "taken_moving",
            "taken_member",
            "taken_place",
            "taken_open",
            "taken_torque",
        ],
        vec![upto(p.value("tolerated")), upto(31), truth()],
        cc_link::State::INITIAL,
        move |state, i, o| {
            let told = i[3] | i[4] << 1 | i[5] << 2 | i[6] << 3 | i[7] << 4;
            let inputs = cc_link::Inputs {
                main_switch: i[0] != 0,
                sound: i[1] != 0,
                fatal: i[2] != 0,
                drive: drive(told),
            };
            let (after, out) = next(state, &config, &inputs);
            o.extend([
                stop_rank(out.demand),
                bit(out.drive.moving),
                bit(out.drive.group.is_some()),
                i64::from(out.drive.position.0),
                bit(out.drive.brake_open),
                bit(out.drive.torque),
            ]);
            after
        },
    ))
}
