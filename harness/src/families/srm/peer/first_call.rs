//! The checks of the parameters in the first call. In the tables the parameters are inputs that only the first call reads; in the
//! monitors they are the configuration.

use crate::diff::peer::cells::{get, set};
use stillpoint_monitors::contract::Contract;
use stillpoint_monitors::mutant::Mutant;
use stillpoint_monitors::srm::common::ErrReact;
use stillpoint_monitors::srm::interpolation::Curve;
use stillpoint_monitors::srm::{
    brake_test, endzone, load_monitor, safe_pos, sbr_monitor, slp_monitor,
};

use crate::diff::peer::adapter::Adapter;
use crate::diff::peer::cells::numbers;
use crate::diff::peer::numbers::{truth, upto};
use crate::diff::peer::{Made, Params, chosen};
use crate::diff::product::Values;

/// The tables, each with the monitor of its block.
pub(super) const MACHINES: &[(&str, &str)] = &[
    ("pos_parameters", "safe_pos"),
    ("slp_parameters", "slp_monitor"),
    ("endzone_parameters", "endzone"),
    ("sbr_parameters", "sbr_monitor"),
    ("brake_parameters", "brake_test"),
    ("load_parameters", "load_monitor"),
];

/// Values at and beside the limits of most parameters.
const FEW: Values = Values::List(&[-10, 0, 1, 20]);

pub(super) fn make(machine: &str, _: &Params, mutant: Option<Mutant>) -> Made {
    Ok(Some(match machine {
        "pos_parameters" => named::<safe_pos::Monitor>(
            mutant,
            &[
                "t_sample",
                "possi_t_sample",
                "v_sync_intervall",
                "v_disc_window",
                "pos_disc_window",
                "pos_startup_tol",
                "v_max",
                "v_standstill",
                "pos_max",
                "pos_min",
            ],
            &["bit_0", "bit_1", "bit_2"],
        )
        .explored(&["t_sample"], Values::List(&[-10, 0, 2, 3, 2_046, 2_047]))
        .explored(&["possi_t_sample"], Values::List(&[0, 1, 1_023, 1_024]))
        .explored(&["v_sync_intervall"], Values::List(&[-6, 0, 4, 6]))
        .explored(
            &["v_disc_window", "pos_disc_window", "pos_startup_tol"],
            Values::List(&[-1, 0]),
        )
        .explored(
            &["v_max", "v_standstill", "pos_max", "pos_min"],
            Values::List(&[4, 5]),
        ),
        "slp_parameters" => named::<slp_monitor::Monitor>(mutant, &["vmax_release"], &["bit_4"])
            .explored(&["vmax_release"], FEW),
        "endzone_parameters" => peer::<endzone::Monitor>(
            mutant,
            &["x_0", "v_0", "ordered", "v_16", "vmax_release"],
            &["bit_3", "bit_4"],
            |i| endzone::Config {
                vmax_release: i[4],
                interpolation: curve(i),
                vinv_retract: endzone::VinvRetract::Stop,
                ez_dir: endzone::EzDir::Expire,
                err_react: ErrReact::Safe,
            },
        )
        .explored(&["x_0", "v_0"], Values::List(&[-1, 0, 1]))
        .explored(&["ordered"], Values::List(&[0, 1]))
        .explored(
            &["v_16", "vmax_release"],
            Values::List(&[-1, 0, 1, 2, 99, 100]),
        ),
        "sbr_parameters" => named::<sbr_monitor::Monitor>(
            mutant,
            &["t_sample", "t_ramp", "v_max", "maxtol_v"],
            &["bit_1", "bit_3", "bit_4", "bit_5", "bit_6"],
        )
        .explored(&["t_sample"], Values::List(&[-10, -1, 0, 1, 10]))
        .explored(&["t_ramp"], Values::List(&[-15, -10, 0, 5, 10, 15, 20]))
        .explored(&["v_max", "maxtol_v"], Values::List(&[-4, -3, 0, 3, 4])),
        "brake_parameters" => named::<brake_test::Monitor>(
            mutant,
            &[
                "t_sample",
                "t_open_br_1",
                "t_close_br_1",
                "t_open_br_2",
                "t_close_br_2",
                "pos_tolerance",
                "vmax_release",
            ],
            &["bit_4", "bit_5"],
        )
        .explored(&["t_sample"], Values::List(&[-10, 0, 1, 10]))
        .explored(
            &["t_open_br_1", "t_close_br_1", "t_open_br_2", "t_close_br_2"],
            Values::List(&[0, 1, 15, 20]),
        )
        .explored(
            &["pos_tolerance", "vmax_release"],
            Values::List(&[-1, 0, 1]),
        ),
        "load_parameters" => named::<load_monitor::Monitor>(
            mutant,
            &[
                "t_sample",
                "t_settle",
                "t_test",
                "vmax_release",
                "maxload_dyn",
                "maxload_stat",
                "minload",
                "cal_value",
                "maxtol_load",
                "maxtol_cal",
            ],
            &["bit_3", "bit_6", "bit_8"],
        )
        .explored(&["t_sample", "t_settle"], Values::List(&[-10, 0, 10]))
        .explored(&["t_test"], Values::List(&[10, 20, 25]))
        .explored(&["vmax_release"], Values::List(&[0, 1]))
        .explored(
            &["maxload_dyn", "maxload_stat"],
            Values::List(&[9_999, 10_000, 10_001]),
        )
        .explored(&["minload"], Values::List(&[-1, 0, 9_999]))
        .explored(
            &["cal_value", "maxtol_load", "maxtol_cal"],
            Values::List(&[-1, 10_000]),
        ),
        _ => return Ok(None),
    }))
}

/// An envelope whose first point, order and last velocity are these; all other points lie where the first one does.
fn curve(i: &[i32]) -> Curve {
    let (x_0, v_0, ordered, v_16) = (i[0], i[1], i[2] == 1, i[3]);
    Curve {
        x: [x_0; 16],
        v: [v_0; 16],
        x_16: x_0.wrapping_sub(i32::from(!ordered)),
        v_16,
    }
}

/// The check of a monitor whose parameters are called as in the table; those that the table does not have are 0.
fn named<M: Contract>(
    mutant: Option<Mutant>,
    inputs: &'static [&'static str],
    outputs: &'static [&'static str],
) -> Adapter {
    let places: Vec<Option<usize>> = numbers::<M::Config>("config")
        .iter()
        .map(|number| inputs.iter().position(|name| *name == number.short))
        .collect();
    peer::<M>(mutant, inputs, outputs, move |i| {
        let values = places.iter();
        set(&mut values.map(|place| place.map_or(0, |k| i64::from(i[k]))))
    })
}

/// The check of a monitor whose configuration is made of the inputs: what the first call says stays, whatever they are later. An output
/// `bit_n` is bit n of `DIAG`.
fn peer<M: Contract>(
    mutant: Option<Mutant>,
    inputs: &'static [&'static str],
    outputs: &'static [&'static str],
    config: impl Fn(&[i32]) -> M::Config + Send + Sync + 'static,
) -> Adapter {
    let next = chosen::<M>(mutant);
    let bits: Vec<u32> = outputs
        .iter()
        .filter_map(|name| name.strip_prefix("bit_")?.parse().ok())
        .collect();
    let place = numbers::<M::Outputs>("outputs")
        .iter()
        .position(|number| number.short == "diag");
    let step = move |cells: &mut [i32], i: &[i32], o: &mut Vec<i64>| {
        if cells[0] == 0 {
            let (_, outputs) = next(M::INITIAL, &config(i), &set(&mut std::iter::repeat(0)));
            let mut said = Vec::new();
            get(outputs, &mut |number| said.push(number));
            let diag = place.and_then(|k| said.get(k)).copied().unwrap_or(0);
            cells[0] = 1;
            cells[1] = i32::try_from(diag).unwrap_or(0);
        }
        o.extend(bits.iter().map(|bit| i64::from(cells[1] >> bit & 1)));
    };
    let domains = vec![truth(), upto(i32::from(u16::MAX))];
    Adapter::of(inputs.to_vec(), outputs.to_vec(), domains, vec![0, 0], step)
}
