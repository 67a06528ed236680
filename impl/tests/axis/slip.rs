//! An axis with two encoders and slip between them. What is injected is a speed, never an offset: the tolerance is a speed, and
//! whether it acts at its value shows only over the cycles from one comparison of the positions to the next.

use stillpoint_monitors::kernel::{Position, Speed};
use stillpoint_monitors::sinumerik::alarm::Alarm;
use stillpoint_monitors::sinumerik::code::Code;
use stillpoint_monitors::sinumerik::fault::FaultState;
use stillpoint_monitors::sinumerik::level::Level;
use stillpoint_monitors::sinumerik::pair::Outputs;
use stillpoint_monitors::sinumerik::parameters::{Encoders, Parameters};

use crate::machine::{Machine, both, levels, reference};

/// The cycles of one pass of the comparison.
const PASS: u32 = 84;

/// SBH/SG and synchronisation of the actual values, two encoders.
fn slipping(tolerated: u32) -> Parameters {
    let mut parameters = Parameters {
        function_enable: 0b1001,
        slip_velo_tol: tolerated,
        ..Parameters::default()
    };
    parameters.installation.encoders = Encoders::Two;
    parameters
}

/// An axis that goes at one speed at the encoder of the drive and at another one at that of the NCK.
struct Axis {
    machine: Machine,
    /// The speeds, and for how many cycles.
    speeds: [i64; 2],
    moved: i64,
    /// Where each encoder was at first: NCK, drive.
    from: [i64; 2],
    cycle_us: i64,
    rotary: bool,
}

impl Axis {
    fn new(parameters: &Parameters) -> Self {
        Self {
            machine: Machine::powered(parameters, false, None),
            speeds: [0; 2],
            moved: 0,
            from: [0; 2],
            cycle_us: i64::from(parameters.sysclock_cycle_time)
                * i64::from(parameters.safety_sysclock_time_ratio),
            rotary: parameters.is_rot_ax,
        }
    }

    /// The position after so many cycles at a speed in um/min or 0.001 rev/min, as an encoder counts it: rounded down.
    fn way(&self, speed: i64, cycles: i64) -> i64 {
        let (numerator, denominator) = if self.rotary {
            (3, 500_000)
        } else {
            (1, 60_000_000)
        };
        (speed * self.cycle_us * cycles * numerator).div_euclid(denominator)
    }

    /// One cycle at these speeds: NCK, drive.
    fn step(&mut self, speeds: [i64; 2]) -> Outputs {
        if speeds != self.speeds {
            let inputs = self.machine.inputs;
            self.from = [inputs.nck.position.0.into(), inputs.drive.position.0.into()];
            (self.speeds, self.moved) = (speeds, 0);
        }
        self.moved += 1;
        let [nck, drive] = speeds;
        let at = |from: i64, way: i64| Position(i32::try_from(from + way).expect("a short run"));
        self.machine.inputs.nck.position = at(self.from[0], self.way(nck, self.moved));
        self.machine.inputs.drive.position = at(self.from[1], self.way(drive, self.moved));
        self.machine.step()
    }

    /// The code of the first fault within so many cycles at these speeds.
    fn fault(&mut self, speeds: [i64; 2], cycles: u32) -> Option<u16> {
        for _ in 0..cycles {
            let outputs = self.step(speeds);
            let codes = [outputs.nck.code, outputs.drive.code];
            if let Some(code) = codes.into_iter().find(|code| !code.is_none()) {
                return Some(code.number());
            }
        }
        None
    }
}

/// S840D-SLIP-504, S840D-KDV-505/b, lines 7303, 1816, 8212: a slip at the speed that the machine datum names is tolerated, in
/// both directions, at standstill of the load and on a moving axis, for any length of time; one a little faster is not.
#[test]
fn the_tolerated_speed_is_tolerated_and_a_little_more_is_not() {
    for (rotary, cycle, tolerated) in [
        (false, 3, 60_000),
        (false, 3, 6_000),
        (false, 3, 1_000_000),
        (false, 1, 7),
        (false, 6, 123_457),
        (false, 3, 0),
        (true, 3, 1_000_000),
        (true, 6, 6_000),
        (true, 1, 1),
    ] {
        let parameters = Parameters {
            is_rot_ax: rotary,
            safety_sysclock_time_ratio: cycle,
            ..slipping(tolerated)
        };
        let tolerated = i64::from(tolerated);
        // Six increments of a pass, as a speed: what the tolerance is exact to.
        let a_little = if rotary {
            6 * 500_000 / (3 * 84 * 4_000 * i64::from(cycle)) + 1
        } else {
            6 * 60_000_000 / (84 * 4_000 * i64::from(cycle)) + 1
        };
        for feed in [0, 1_000, -777_777, 2_000_000] {
            for sign in [1, -1] {
                let context =
                    format!("rotary {rotary}, {cycle} clocks, {sign} * {tolerated} at {feed}");
                let mut axis = Axis::new(&parameters);
                let slip = [feed, feed + sign * tolerated];
                assert_eq!(axis.fault(slip, 25 * PASS), None, "{context}");
                let more = [feed, feed + sign * (tolerated + a_little)];
                let code = axis
                    .fault(more, 3 * PASS)
                    .unwrap_or_else(|| panic!("{context}: none"));
                assert!(
                    code == 3 || (44..=57).contains(&code),
                    "{context}: code {code}"
                );
            }
        }
    }
}

/// S840D-SLIP-502, S840D-SLIP-504, S840D-KDV-505/b: a slip beyond the tolerance is STOP F with code 3 where the positions
/// are compared, and is corrected as well, each channel by half; so it can be acknowledged.
#[test]
fn slip_is_synchronised() {
    let mut axis = Axis::new(&slipping(60_000));
    // Two mm/min more than a limit comparison tolerates would show as code 44: the slip begins after those items.
    while axis.machine.cycle % PASS != 60 {
        let _ = axis.step([0, 0]);
    }
    let code = axis.fault([0, 240_000], PASS);
    assert_eq!(code, Some(Code::POSITION.number()));
    assert_eq!(axis.machine.cycle % PASS, 3);
    let state = *axis.machine.state();
    // 26 cycles of 48 um: that of the comparison is not compared yet.
    assert_eq!(
        (state.nck.slip.offset, state.drive.slip.offset),
        (624, -624)
    );
    assert_eq!(state.nck.channel.fault.fault, FaultState::Latched);
    let outputs = axis.machine.once(|local| local.reset = true);
    assert!(outputs.nck.reset_taken && !outputs.nck.channel.start_inhibit);
    assert_eq!(axis.fault([0, 0], 3 * PASS), None);
}

/// S840D-SLIP-502: the feed of a cycle is no slip: the positions compared are of one instant.
#[test]
fn feed_is_no_slip() {
    let mut axis = Axis::new(&slipping(0));
    for _ in 0..300 {
        let outputs = axis.step([5_000_000; 2]);
        assert!(outputs.nck.code.is_none());
        assert_eq!(outputs.nck.position, axis.machine.inputs.nck.position);
    }
}

/// S840D-SLIP-505/b, line 1834: the operating stop of the channel whose encoder stands does not see that its position is
/// corrected by half of what the other encoder slips, though its window is the smallest one.
#[test]
fn the_operating_stop_does_not_see_the_correction() {
    let parameters = Parameters {
        standstill_tol: 1,
        ..slipping(60_000)
    };
    let mut axis = Axis::new(&parameters);
    axis.machine.both(|local| {
        local.sge.sbh_sg_off = false;
        local.sge.sbh_off = false;
    });
    let slip = [0, 60_000];
    // The channel whose own encoder slips sees it, and stops; both stop.
    let _ = axis.step(slip);
    let outputs = axis.step(slip);
    assert!(outputs.drive.channel.standstill.violated);
    assert!(outputs.drive.alarms.contains(Alarm::Standstill));
    for _ in 0..4 * PASS {
        let outputs = axis.step(slip);
        assert!(!outputs.nck.channel.standstill.violated);
        assert!(!outputs.nck.alarms.contains(Alarm::Standstill));
        assert_ne!(outputs.nck.channel.stop.level, Level::None);
    }
    assert!(axis.machine.state().nck.slip.offset > 1_000);
}

/// S840D-SLIP-505/a, S840D-SLIP-505/e, lines 1834 to 1836: the correction of a pass, far above the limit as a way of one cycle, is no speed. A
/// violation in one channel raises the alarm there alone, and the stop in both.
#[test]
fn the_speed_monitor_does_not_see_the_correction() {
    let parameters = Parameters {
        // 0.2 mm a cycle; half of a pass of the slip is 2.5 mm.
        velo_limit: [1_000_000; 4],
        ..slipping(300_000)
    };
    let mut axis = Axis::new(&parameters);
    axis.machine.both(|local| local.sge.sbh_sg_off = false);
    for _ in 0..4 * PASS {
        let outputs = axis.step([700_000, 1_000_000]);
        for channel in [outputs.nck, outputs.drive] {
            assert!(!channel.channel.speed.violated && channel.code.is_none());
            assert!(channel.channel.motion.speed <= Speed(200));
        }
    }
    assert!(axis.machine.state().nck.slip.offset > 2_000);
    let outputs = axis.step([750_000, 1_010_000]);
    assert!(outputs.drive.alarms.contains(Alarm::SpeedLimit));
    assert!(!outputs.nck.alarms.contains(Alarm::SpeedLimit));
    let outputs = axis.step([750_000, 1_010_000]);
    assert!(!outputs.nck.alarms.contains(Alarm::SpeedLimit));
    assert_eq!(levels(&outputs), both(Level::C));
}

/// S840D-SLIP-505/c, S840D-SLIP-505/d, line 1834: while STOP C brakes, and n<n_x is shown, the corrections of the passes, 0.5 mm each, are no
/// speed. The tolerance of the ramp is none, and n_x 0.1 mm a cycle.
#[test]
fn the_ramp_and_n_x_do_not_see_the_correction() {
    let parameters = Parameters {
        function_enable: 0b100_1001,
        stop_switch_time_c: 10_000_000,
        stop_velo_tol: 0,
        velo_x: 500_000,
        ..slipping(60_000)
    };
    let mut axis = Axis::new(&parameters);
    axis.machine.both(|local| local.sge.stop_c_off = false);
    let _ = axis.step([0, 0]);
    let mut before = *axis.machine.state();
    let mut corrected = 0;
    // Below n_x, and no faster than the ramp permits, in each channel by its own encoder.
    for _ in 0..6 * PASS {
        let outputs = axis.step([0, 60_000]);
        let state = *axis.machine.state();
        let far = state.nck.slip.offset.abs_diff(before.nck.slip.offset) > 400;
        corrected += u32::from(far);
        for channel in [outputs.nck, outputs.drive] {
            assert_eq!(channel.channel.stop.level, Level::C);
            assert!(channel.channel.stop.sbr_on, "STOP C brakes");
            assert!(!channel.channel.ramp.violated);
            assert!(channel.sga.below_n_x);
        }
        before = state;
    }
    assert!(corrected >= 5, "{corrected} passes were corrected");
}

/// S840D-SIGNAL-018/b, S840D-SLIP-505/f, S840D-NX-002, line 1838: with slip n < n_x may lastingly differ between the channels; no code 2, no
/// stop. Speeds that differ by more than the slip tolerated are a difference.
#[test]
fn n_below_n_x_may_differ_with_slip() {
    // n_x = 20 mm/min is 4 um a cycle, 6 mm/min are 1.2 um.
    let mut axis = Axis::new(&slipping(6_000));
    for _ in 0..10 * PASS {
        let outputs = axis.step([15_000, 20_000]);
        assert!(outputs.nck.code.is_none() && outputs.drive.code.is_none());
        assert!(outputs.nck.sga.below_n_x);
    }
    let outputs = axis.step([15_000, 20_000]);
    assert!(!outputs.drive.sga.below_n_x, "it differs statically");
    assert_eq!(levels(&outputs), both(Level::None));
    // n_x is in between, and far from both.
    let mut axis = Axis::new(&Parameters {
        velo_x: 200_000,
        ..slipping(6_000)
    });
    while axis.machine.cycle % PASS != 0 {
        let _ = axis.step([0, 0]);
    }
    assert_eq!(axis.fault([5_000, 400_000], 2), Some(2));
    // Neither SBH, SG, SE nor SN is active: STOP F stays alone.
    for _ in 0..PASS {
        let outputs = axis.step([5_000, 400_000]);
        assert_eq!(levels(&outputs), both(Level::None));
        assert!(outputs.nck.channel.fault.interlock);
    }
}

/// S840D-SLIP-502, S840D-KDV-709: an axis that has slipped a long way stops and is held: the limits of the operating stop are
/// of the corrected position in both channels, so that codes 52 and 53 find nothing.
#[test]
fn a_long_slip_is_no_difference_of_the_operating_stop() {
    let mut axis = Axis::new(&slipping(60_000));
    axis.machine.both(|local| local.sge.sbh_sg_off = false);
    assert_eq!(axis.fault([1_000_000, 1_060_000], 20 * PASS), None);
    assert_eq!(axis.fault([0, 0], 5), None);
    axis.machine.both(|local| local.sge.sbh_off = false);
    assert_eq!(axis.fault([0, 0], 3 * PASS), None);
    // The operating stop of the end of a stop captures its own position.
    axis.machine.both(|local| local.sge.sbh_off = true);
    assert_eq!(axis.fault([1_000_000, 1_060_000], 20 * PASS), None);
    axis.machine.both(|local| local.sge.sbh_off = false);
    assert_eq!(axis.fault([0, 0], 3 * PASS), None);
}

/// S840D-SLIP-502, S840D-GEAR-506, lines 1794, 1824: referencing sets the actual value anew and parking lets the encoders turn
/// apart; what they leave between the channels is corrected and no slip, in whatever item is due, also when one channel is a
/// cycle later.
#[test]
fn referencing_and_parking_synchronise() {
    for start in 0..PASS {
        for late in [false, true] {
            let mut axis = Axis::new(&slipping(6_000));
            assert_eq!(axis.fault([0, 0], start), None);
            // The motor encoder starts anew, that of the load at the reference point.
            axis.from = [0, 50_000];
            if late {
                axis.machine.inputs.drive.position = Position(50_000);
                axis.machine.inputs.drive.referenced = true;
                let outputs = axis.machine.step();
                assert!(outputs.nck.code.is_none() && outputs.drive.code.is_none());
                axis.machine.inputs.nck.referenced = true;
            } else {
                axis.machine.both(|local| reference(local, 0));
            }
            axis.machine.inputs.drive.refpos = Position(50_000);
            assert_eq!(axis.fault([0, 0], 2 * PASS), None, "referenced at {start}");
            axis.machine.both(|local| local.referenced = false);

            axis.machine.both(|local| local.parking = true);
            axis.from = [7_000, 90_000];
            assert_eq!(axis.fault([0, 0], 10), None);
            axis.machine.inputs.nck.parking = false;
            if late {
                let outputs = axis.machine.step();
                assert!(outputs.nck.code.is_none() && outputs.drive.code.is_none());
            }
            axis.machine.inputs.drive.parking = false;
            assert_eq!(axis.fault([0, 0], 2 * PASS), None, "parked at {start}");
        }
    }
}
