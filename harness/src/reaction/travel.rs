//! How far an axis travels while a reaction takes place. Exact integers, rounded up.

use stillpoint_machine::reaction::{Outcome, Step};

/// Speed and acceleration that a way is counted at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Motion {
    /// At the violation, in base units of way a minute.
    pub speed: i64,
    /// Of a drive that accelerates until the stop works, in base units of way a second squared.
    pub acceleration: i64,
}

/// Time and way until a reaction has come to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct End {
    /// Microseconds.
    pub time: i128,
    /// Base units of way.
    pub way: i128,
    /// More comes that has to be measured.
    pub open: bool,
}

const MINUTE: i128 = 60_000_000;
const SECOND: i128 = 1_000_000;

/// The end of a chain in one outcome; stages before `accelerates` are those in which the drive may accelerate.
pub fn end(steps: &[Step], outcome: &Outcome, accelerates: usize, motion: Motion) -> End {
    let mut end = End::default();
    let mut speed = i128::from(motion.speed);
    for step in steps.iter().filter(|s| s.stage < outcome.stages) {
        let Some(time) = step.time.map(i128::from) else {
            end.open = true;
            continue;
        };
        end.time += time;
        end.way += i128::from(step.length);
        if outcome.brakes == Some(step.stage) {
            // Half the way of an axis that does not brake.
            end.way += up(speed * time, 2 * MINUTE);
            continue;
        }
        if outcome.brakes.is_some_and(|stage| stage < step.stage) {
            // It stands.
            continue;
        }
        let gain = match step.stage < accelerates {
            true => i128::from(motion.acceleration),
            false => 0,
        };
        let fastest = speed + i128::from(step.margin);
        end.way += up(fastest * time, MINUTE) + up(gain * time * time, 2 * SECOND * SECOND);
        // What was gained is not lost: the next monitor tolerates its own margin above it.
        speed = fastest + up(gain * time * 60, SECOND);
    }
    end
}

/// `a / b` rounded up; neither is negative.
fn up(a: i128, b: i128) -> i128 {
    a / b + i128::from(a % b != 0)
}

#[cfg(test)]
mod tests {
    use stillpoint_machine::reaction::Basis;

    use super::*;

    fn step(stage: usize, time: Option<i64>, length: i64, margin: i64) -> Step {
        Step {
            stage,
            text: String::new(),
            formula: String::new(),
            values: Vec::new(),
            time,
            length,
            margin,
            basis: Basis::Computed,
            id: Vec::new(),
            property: None,
        }
    }

    fn outcome(stages: usize, brakes: Option<usize>) -> Outcome {
        Outcome {
            title: String::new(),
            text: String::new(),
            stages,
            brakes,
        }
    }

    // 6000 mm/min are 0.1 mm/ms.
    const STEADY: Motion = Motion {
        speed: 6_000_000,
        acceleration: 0,
    };

    #[test]
    fn steady_then_braking_evenly() {
        let steps = [step(1, Some(30_000), 0, 0), step(2, Some(300_000), 0, 0)];
        let braked = end(&steps, &outcome(3, Some(2)), 2, STEADY);
        assert_eq!((braked.time, braked.way), (330_000, 3_000 + 15_000));
        let free = end(&steps, &outcome(4, None), 2, STEADY);
        assert_eq!(free.way, 33_000);
    }

    #[test]
    fn an_axis_that_has_braked_stands() {
        let steps = [step(2, Some(300_000), 0, 0), step(3, Some(100_000), 0, 0)];
        let braked = end(&steps, &outcome(4, Some(2)), 2, STEADY);
        assert_eq!((braked.time, braked.way), (400_000, 15_000));
    }

    #[test]
    fn an_acceleration_counts_until_the_stop_works() {
        // 1000 mm/s2 for 100 ms: 5 mm more, and 100 mm/s more speed for what follows.
        let steps = [step(1, Some(100_000), 0, 0), step(2, Some(100_000), 0, 0)];
        let motion = Motion {
            acceleration: 1_000_000,
            ..STEADY
        };
        let free = end(&steps, &outcome(3, None), 2, motion);
        assert_eq!(free.way, 10_000 + 5_000 + 20_000);
        let early = end(&steps, &outcome(3, None), 0, motion);
        assert_eq!(early.way, 20_000);
    }

    #[test]
    fn tolerances_windows_and_what_is_measured() {
        let steps = [
            step(1, Some(0), 500, 0),
            step(2, Some(60_000), 0, 1_000_000),
            step(3, None, 0, 0),
        ];
        let whole = end(&steps, &outcome(4, None), 2, STEADY);
        assert_eq!(whole.way, 500 + 7_000);
        assert!(whole.open);
        // 60 ms at 7000 mm/min and 60 ms more, that no monitor minds.
        let after = [steps[1].clone(), step(3, Some(60_000), 0, 0)];
        assert_eq!(end(&after, &outcome(4, None), 2, STEADY).way, 14_000);
        assert!(!end(&steps, &outcome(3, None), 2, STEADY).open);
        let still = end(
            &steps,
            &outcome(3, None),
            2,
            Motion {
                speed: 0,
                acceleration: 0,
            },
        );
        assert_eq!(still.way, 500 + 1_000);
    }

    #[test]
    fn fractions_are_rounded_up() {
        let steps = [step(1, Some(1), 0, 0)];
        assert_eq!(end(&steps, &outcome(2, None), 0, STEADY).way, 1);
    }
}
