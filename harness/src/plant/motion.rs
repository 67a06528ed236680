//! A simple axis: it follows its setpoint with limited acceleration, brakes on a ramp, coasts without torque.
//!
//! All quantities are integers, so that a run gives the same result on every machine: positions in thousandths of an
//! increment (nm, or millionths of a degree), speeds in these per cycle, accelerations in these per cycle and cycle. In
//! each cycle first the speed changes. A setpoint is reached in steps of whole cycles; an axis that brakes, coasts or sags moves
//! under constant acceleration, its way rounded away from where it was: over-travel is never told too small.
//!
//! What the control and the monitors ask for reaches the drive after its dead time; only the pulses go off at once. The
//! position control lets the axis lag behind its setpoint by the speed times the following time.

use std::collections::VecDeque;

/// The mechanics of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mechanics {
    /// With which it follows its setpoint.
    pub acceleration: i64,
    /// At the current limit: the hardest stop that keeps the torque.
    pub braking: i64,
    /// Along the path.
    pub path_braking: i64,
    /// Of friction, without torque.
    pub friction: i64,
    /// Towards minus, without torque and until the holding brake has closed; 0 for an axis that does not sag.
    pub sag: i64,
    /// Cycles from the loss of torque until the holding brake has closed; none without such a brake.
    pub brake_time: Option<u32>,
    /// Cycles until the drive does what it is asked for; pulses are cancelled at once.
    pub dead_time: u32,
    /// Cycles by which the axis lags behind its setpoint: the reciprocal of the position controller's gain.
    pub following: u32,
}

/// What the control asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Setpoint {
    /// Speed with sign; with a target its magnitude counts.
    pub speed: i64,
    /// Where to stop.
    pub target: Option<i64>,
}

/// What moves the axis in a cycle, in rising order of precedence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Actuation {
    /// It follows its setpoint.
    Follow,
    /// It brakes along its path.
    Path,
    /// It brakes at the current limit.
    CurrentLimit,
    /// It presses against its closed brakes, to test them.
    BrakeTest,
    /// It has no torque.
    Coast,
}

impl Actuation {
    /// The word for it.
    pub const fn keyword(self) -> &'static str {
        match self {
            Self::Follow => "FOLLOW",
            Self::Path => "BRAKE_PATH",
            Self::CurrentLimit => "BRAKE_MAX",
            Self::BrakeTest => "BRAKE_TEST",
            Self::Coast => "COAST",
        }
    }
}

/// What the drive was asked for in a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Command {
    drive: Actuation,
    setpoint: Setpoint,
    limit: Option<i64>,
}

/// An axis in motion.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plant {
    mechanics: Mechanics,
    /// Where it is.
    pub position: i64,
    /// How fast it goes.
    pub speed: i64,
    /// What it was asked for.
    pub setpoint: Setpoint,
    /// The greatest speed that the control lets its setpoint have; none: any.
    pub limit: Option<i64>,
    /// What its brakes hold against in this cycle, as an acceleration; none: it has the brake of [`Mechanics::brake_time`], or none.
    pub held: Option<i64>,
    /// The acceleration that the torque of a brake test would give it if nothing held it, with its sign.
    pub press: i64,
    without_torque: u32,
    /// What it was asked for in the last cycles and has not done yet.
    underway: VecDeque<Command>,
    /// Where the axis would be, and how fast, if it did not lag.
    ideal: (i64, i64),
}

impl Plant {
    /// An axis at rest.
    pub fn new(mechanics: Mechanics, position: i64) -> Self {
        Self {
            mechanics,
            position,
            speed: 0,
            setpoint: Setpoint {
                speed: 0,
                target: None,
            },
            limit: None,
            held: None,
            press: 0,
            without_torque: 0,
            underway: VecDeque::new(),
            ideal: (position, 0),
        }
    }

    /// The setpoint of the speed in this cycle.
    pub fn wanted(&self) -> i64 {
        self.asked(self.setpoint, self.limit)
    }

    /// The speed that a setpoint asks for.
    fn asked(&self, setpoint: Setpoint, limit: Option<i64>) -> i64 {
        let most = limit.unwrap_or(i64::MAX);
        let Some(target) = setpoint.target else {
            return setpoint.speed.clamp(-most, most);
        };
        let way = target - self.ideal.0;
        let rate = self.mechanics.acceleration;
        let rate = i128::from(rate);
        // The greatest speed from which the steps v, v - rate, v - 2 rate ... are not longer than the way: after q whole
        // rates it is (way + rate * q * (q + 1) / 2) / (q + 1).
        let size = i128::from(way.abs());
        let whole = ((1 + 8 * size / rate).isqrt() - 1) / 2;
        let limit = (size + rate * whole * (whole + 1) / 2) / (whole + 1);
        let speed = i64::try_from(limit).unwrap_or(i64::MAX);
        speed.min(setpoint.speed.abs()).min(most) * way.signum()
    }

    /// One cycle.
    pub fn advance(&mut self, drive: Actuation) {
        let m = self.mechanics;
        let Command {
            drive,
            setpoint,
            limit,
        } = self.acting(drive);
        self.without_torque = match drive {
            Actuation::Coast => self.without_torque.saturating_add(1),
            _ => 0,
        };
        let held = self.held.unwrap_or(0);
        if drive == Actuation::Follow && held == 0 {
            self.follow(self.asked(setpoint, limit));
            return;
        }
        let before = self.speed;
        let closed = m.brake_time.is_some_and(|time| self.without_torque > time);
        let towards =
            |speed: i64, wanted: i64, rate: i64| speed + (wanted - speed).clamp(-rate, rate);
        self.speed = match drive {
            // Nothing moves against a closed brake.
            Actuation::Follow => towards(self.speed, 0, held),
            Actuation::BrakeTest => towards(self.speed + self.press, 0, held),
            Actuation::Path => towards(self.speed, 0, m.path_braking),
            Actuation::CurrentLimit => towards(self.speed, 0, m.braking),
            Actuation::Coast if closed => towards(self.speed, 0, m.braking),
            Actuation::Coast if held > 0 => towards(self.speed - m.sag, 0, held),
            Actuation::Coast if m.sag > 0 => {
                self.speed - m.sag + friction(self.speed, m.friction.min(m.sag))
            }
            Actuation::Coast => towards(self.speed, 0, m.friction),
        };
        self.position += match drive {
            Actuation::Follow | Actuation::BrakeTest => way(before, self.speed, held.max(1)),
            Actuation::Path => way(before, self.speed, m.path_braking),
            Actuation::CurrentLimit => way(before, self.speed, m.braking),
            Actuation::Coast if closed => way(before, self.speed, m.braking),
            Actuation::Coast if held > 0 => way(before, self.speed, held),
            Actuation::Coast => way(before, self.speed, m.friction),
        };
        self.ideal = (self.position, self.speed);
    }

    /// What the drive does in this cycle.
    fn acting(&mut self, drive: Actuation) -> Command {
        let now = Command {
            drive,
            setpoint: self.setpoint,
            limit: self.limit,
        };
        if drive == Actuation::Coast {
            self.underway.clear();
            return now;
        }
        self.underway.push_back(now);
        let dead = self.mechanics.dead_time as usize;
        match self.underway.len() > dead {
            true => self.underway.pop_front().unwrap_or(now),
            // At first nothing was asked for: the axis does what it did, with torque.
            false => Command {
                drive: Actuation::Follow,
                setpoint: Setpoint::default(),
                limit: None,
            },
        }
    }

    /// A cycle of the position control, with this speed asked for.
    fn follow(&mut self, wanted: i64) {
        let m = self.mechanics;
        let (position, speed) = self.ideal;
        let speed = speed + (wanted - speed).clamp(-m.acceleration, m.acceleration);
        self.ideal = (position + speed, speed);
        let error = self.ideal.0 - self.position;
        let lag = i64::from(m.following) + 1;
        // The last bit at once: a part of it would be nothing.
        self.speed = match error.abs() < lag {
            true => error,
            false => error / lag,
        };
        self.position += self.speed;
    }

    /// With which acceleration the hardest stop brakes it, and a brake that is in order.
    pub const fn braking(&self) -> i64 {
        self.mechanics.braking
    }

    /// Somebody moves it by hand, at once.
    pub fn shift(&mut self, by: i64) {
        self.position += by;
        self.ideal.0 += by;
    }

    /// Whether it stands.
    pub const fn stands(&self) -> bool {
        self.speed == 0
    }
}

/// The way of a cycle from one speed to another, rounded away from zero; an axis that brakes with `rate` and stands before the
/// cycle is over has gone no further than until then.
fn way(before: i64, after: i64, rate: i64) -> i64 {
    let (twice, parts) = match after {
        0 if before.abs() < rate => (before * before.abs(), 2 * rate),
        _ => (before + after, 2),
    };
    let length = twice.unsigned_abs().div_ceil(parts.unsigned_abs());
    twice.signum() * i64::try_from(length).unwrap_or(i64::MAX)
}

/// What friction adds to the speed of an axis that another force moves.
fn friction(speed: i64, rate: i64) -> i64 {
    (-speed).clamp(-rate, rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    const M: Mechanics = Mechanics {
        acceleration: 100,
        braking: 300,
        path_braking: 50,
        friction: 10,
        sag: 0,
        brake_time: None,
        dead_time: 0,
        following: 0,
    };

    fn moving(mechanics: Mechanics, speed: i64) -> Plant {
        Plant {
            speed,
            ideal: (0, speed),
            ..Plant::new(mechanics, 0)
        }
    }

    #[test]
    fn follows_its_setpoint_with_limited_acceleration() {
        let mut plant = Plant::new(M, 0);
        plant.setpoint.speed = 250;
        for (speed, position) in [(100, 100), (200, 300), (250, 550), (250, 800)] {
            plant.advance(Actuation::Follow);
            assert_eq!((plant.speed, plant.position), (speed, position));
        }
    }

    #[test]
    fn reaches_a_target_exactly_and_never_passes_it() {
        for target in [1, 99, 100, 101, 5_000, 123_457, -77_777] {
            for speed in [1, 50, 100, 777, 5_000] {
                let mut plant = Plant::new(M, 0);
                plant.setpoint = Setpoint {
                    speed,
                    target: Some(target),
                };
                for _ in 0..200_000 {
                    plant.advance(Actuation::Follow);
                    assert!(plant.position.abs() <= target.abs(), "{target} at {speed}");
                    if plant.stands() && plant.position == target {
                        break;
                    }
                }
                assert_eq!(
                    (plant.position, plant.speed),
                    (target, 0),
                    "{target} at {speed}"
                );
            }
        }
    }

    #[test]
    fn each_drive_has_its_ramp() {
        for (drive, speed) in [
            (Actuation::Path, 950),
            (Actuation::CurrentLimit, 700),
            (Actuation::Coast, 990),
        ] {
            let mut plant = moving(M, 1_000);
            plant.advance(drive);
            assert_eq!(plant.speed, speed);
            let mut back = moving(M, -1_000);
            back.advance(drive);
            assert_eq!(back.speed, -speed);
        }
        let mut slow = moving(M, 7);
        slow.advance(Actuation::Coast);
        assert!(slow.stands());
    }

    #[test]
    fn a_braking_axis_goes_as_far_as_its_speed_squared_over_twice_the_rate() {
        for (speed, way) in [
            (900, 1_350),
            (1_000, 1_667),
            (299, 150),
            (1, 1),
            (-900, -1_350),
        ] {
            let mut plant = moving(M, speed);
            while !plant.stands() {
                plant.advance(Actuation::CurrentLimit);
            }
            let exact = speed * speed.abs() / 600;
            assert!(plant.position.abs() >= exact.abs(), "{speed}");
            assert_eq!(plant.position, way, "{speed}");
        }
    }

    /// Asked to brake, it goes on for the dead time, and is further by exactly the way of these cycles.
    #[test]
    fn a_dead_time_delays_everything_but_the_pulses() {
        let slow = Mechanics { dead_time: 3, ..M };
        let way = |mechanics: Mechanics, drive: Actuation| {
            let mut plant = Plant::new(mechanics, 0);
            plant.setpoint.speed = 900;
            (0..20).for_each(|_| plant.advance(Actuation::Follow));
            assert_eq!(plant.speed, 900);
            let from = plant.position;
            plant.setpoint = Setpoint::default();
            for _ in 0..200 {
                plant.advance(drive);
            }
            assert!(plant.stands());
            plant.position - from
        };
        assert_eq!(way(M, Actuation::CurrentLimit), 1_350);
        assert_eq!(way(slow, Actuation::CurrentLimit), 1_350 + 3 * 900);
        assert_eq!(way(slow, Actuation::Coast), way(M, Actuation::Coast));
    }

    /// At a steady speed it lags by the following time, and reaches its target all the same without passing it.
    #[test]
    fn an_axis_lags_behind_its_setpoint() {
        let lagging = Mechanics { following: 4, ..M };
        let mut plant = Plant::new(lagging, 0);
        plant.setpoint.speed = 500;
        (0..100).for_each(|_| plant.advance(Actuation::Follow));
        assert_eq!(
            (plant.speed, plant.ideal.0 - plant.position),
            (500, 4 * 500)
        );
        plant.setpoint = Setpoint {
            speed: 500,
            target: Some(plant.position + 20_000),
        };
        let target = plant.position + 20_000;
        for _ in 0..1_000 {
            plant.advance(Actuation::Follow);
            assert!(plant.position <= target);
        }
        assert_eq!((plant.position, plant.speed), (target, 0));
    }

    /// A brake that holds 100 % of the torque holds, one of 60 % lets it go with 40 %; without torque a hoist hangs on a brake of 60 %.
    #[test]
    fn a_brake_holds_no_more_than_its_torque() {
        let mut plant = Plant::new(M, 0);
        plant.press = 300;
        plant.held = Some(300);
        plant.advance(Actuation::BrakeTest);
        assert_eq!((plant.speed, plant.position), (0, 0));
        plant.held = Some(180);
        plant.advance(Actuation::BrakeTest);
        plant.advance(Actuation::BrakeTest);
        assert_eq!((plant.speed, plant.position), (240, 60 + 180));
        plant.advance(Actuation::Follow);
        assert_eq!(plant.speed, 60);
        let mut hoist = Plant::new(Mechanics { sag: 40, ..M }, 0);
        hoist.held = Some(180);
        hoist.advance(Actuation::Coast);
        assert!(hoist.stands());
        hoist.held = Some(30);
        hoist.advance(Actuation::Coast);
        assert_eq!(hoist.speed, -10);
    }

    #[test]
    fn a_vertical_axis_sags_until_its_brake_has_closed() {
        let mut plant = Plant::new(
            Mechanics {
                sag: 40,
                brake_time: Some(2),
                ..M
            },
            0,
        );
        let mut speeds = Vec::new();
        for _ in 0..5 {
            plant.advance(Actuation::Coast);
            speeds.push(plant.speed);
        }
        assert_eq!(speeds, [-40, -70, 0, 0, 0]);
        // 40 / 2, (40 + 70) / 2, 70 * 70 / (2 * 300) rounded up.
        assert_eq!(plant.position, -(20 + 55 + 9));
    }
}
