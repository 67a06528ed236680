//! The monitors of one axis or spindle in one channel.

use stillpoint_monitors::heidenhain::reference::AxisRef;
use stillpoint_monitors::heidenhain::types::{GroupState, Left, Som, Stop, Unit};
use stillpoint_monitors::heidenhain::{
    axis_release, comparison, deceleration, operating_stop, position_limit, reference, speed,
    stop_path,
};
use stillpoint_monitors::kernel::{Distance, Position, Speed};

use super::values::AxisConfig;

/// What a channel knows of the group of an axis at the start of a cycle.
#[derive(Clone, Copy)]
pub(super) struct OfGroup {
    pub state: GroupState,
    pub left: Left,
    /// The stop that runs: its level, and how it brakes.
    pub level: Stop,
    pub on_contour: bool,
    pub emergency_ramp: bool,
}

impl OfGroup {
    /// Of an axis that belongs to none.
    pub const FREE: Self = Self {
        state: GroupState::Auto,
        left: Left::NONE,
        level: Stop::None,
        on_contour: false,
        emergency_ramp: false,
    };
}

/// What a channel sees of an axis in a cycle. Positions are tenths of a micrometre, or ten-thousandths of a degree.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    /// By its encoder.
    pub position: i64,
    /// By the other channel's.
    pub peer: i64,
    /// Where it is.
    pub nominal: i64,
    /// `PP_AxFeedEnable`.
    pub feed: bool,
    pub power_on: bool,
    /// Its marks are passed.
    pub homed: bool,
    /// The permissive key by which a person confirms where it is.
    pub confirm: bool,
    pub peer_checked: bool,
    pub som: Som,
    pub unit: Unit,
    /// A door of its space is open.
    pub door_open: bool,
}

/// What the monitors of an axis say.
#[derive(Clone, Copy, Default)]
pub(super) struct Said {
    /// It moves: 50 mm/min, 10 rpm of a spindle.
    pub moving: bool,
    pub speed: Speed,
    pub release: axis_release::Outputs,
    pub limited: speed::Outputs,
    pub standing: operating_stop::Outputs,
    /// The standstill is watched, from this position on.
    pub stands_at: Option<Position>,
    /// The limit of the speed, where there is one.
    pub limit: Option<Speed>,
    pub reference: reference::Outputs,
    /// What is known of the position.
    pub known: AxisRef,
    /// The limit positions are watched; one is passed.
    pub slp: (bool, bool),
    /// The highest stop demanded, and why.
    pub demand: (Stop, &'static str),
}

/// The monitors.
pub(super) struct Axis {
    config: AxisConfig,
    release: axis_release::Monitor,
    speed: speed::Monitor,
    standstill: operating_stop::Monitor,
    path: stop_path::Monitor,
    position: Option<position_limit::Monitor>,
    comparison: comparison::Monitor,
    deceleration: deceleration::Monitor,
    reference: reference::Monitor,
    /// Positions of the cycle before: seen, nominal. None at first.
    last: Option<(i64, i64)>,
    /// The position that is kept through power-off.
    saved: i64,
    pub said: Said,
}

impl Axis {
    /// At rest; a running one is checked.
    pub(super) fn new(config: AxisConfig, side: usize, running: bool, position: i64) -> Self {
        let kept = match running {
            true => reference::State {
                axis: AxisRef::Checked,
                saved: true,
            },
            false => reference::State::restored(true),
        };
        let checks = config.reference;
        Self {
            release: axis_release::Monitor::new(config.release),
            speed: speed::Monitor::new(config.speed[side]),
            standstill: operating_stop::Monitor::new(config.standstill),
            path: stop_path::Monitor::new(config.path),
            position: config.position.map(position_limit::Monitor::new),
            comparison: comparison::Monitor::new(config.comparison),
            deceleration: deceleration::Monitor::new(config.deceleration),
            // A spindle is never checked.
            reference: reference::Monitor::resume(checks, kept)
                .unwrap_or_else(|_| reference::Monitor::new(checks)),
            last: None,
            saved: position,
            said: Said::default(),
            config,
        }
    }

    /// One cycle.
    pub(super) fn step(&mut self, group: OfGroup, seen: &Seen) {
        let (was, was_nominal) = self.last.unwrap_or((seen.position, seen.nominal));
        if seen.power_on {
            self.saved = was;
        }
        let actual = seen.position - was;
        let magnitude = |way: i64| u32::try_from(way.unsigned_abs()).unwrap_or(u32::MAX);
        let velocity = Speed(magnitude(actual));
        let moving = velocity >= self.config.still;
        let position = Position(wrapped(seen.position));
        let released = group.state.is_released();
        let release = self.release.step(&axis_release::Inputs {
            group_released: released,
            feed: seen.feed,
            moving,
        });
        let limited = self.speed.step(&speed::Inputs {
            state: group.state,
            left: group.left,
            speed: velocity,
        });
        let standing = self.standstill.step(&operating_stop::Inputs {
            watched: group.state == GroupState::Sos
                || (released && release.mode == axis_release::Mode::Sos),
            self_test: false,
            position,
            speed: velocity,
        });
        let path = self.path.step(&stop_path::Inputs {
            braking: group.on_contour || release.mode == axis_release::Mode::Ss2,
            state: group.state,
            position,
        });
        let compared = self.comparison.step(&comparison::Inputs {
            state: group.state,
            deviation: Distance(magnitude(seen.position - seen.nominal)),
            nominal: wrapped(seen.nominal - was_nominal),
            actual: wrapped(actual),
        });
        let braked = self.deceleration.step(&deceleration::Inputs {
            braking: group.emergency_ramp,
            speed: velocity,
        });
        let reference = self.refer(seen, moving);
        let switch = self.position.as_mut().map(|monitor| {
            let inputs = position_limit::Inputs {
                checked: reference.ax_safe,
                changed: false,
                stopping: group.level >= Stop::Ss1,
                position,
            };
            monitor.step(&inputs).demand
        });
        let asked = if release.asks_ss1 {
            Stop::Ss1
        } else {
            Stop::None
        };
        let slp = switch.unwrap_or(Stop::None);
        let demands = [
            (limited.demand, "speed limit exceeded"),
            (
                standing.demand,
                if standing.too_far {
                    "further from standstill than permitted"
                } else {
                    "moves at standstill"
                },
            ),
            (path.demand, "path of an SS2 too long"),
            (slp, "limit position passed"),
            (compared.demand, "nominal and actual value differ"),
            (braked.demand, "not braked on the emergency ramp"),
            (asked, "moves without feed enable"),
            (reference.demand, "check of the axis"),
        ];
        // The first of the highest.
        let highest = demands
            .into_iter()
            .rev()
            .max_by_key(|(stop, _)| *stop)
            .unwrap_or((Stop::None, ""));
        let began = self.standstill.state();
        self.said = Said {
            moving,
            speed: velocity,
            release,
            limited,
            standing,
            stands_at: began.on.then_some(began.begin),
            limit: self.config.speed[0].limit(group.state, group.left),
            reference,
            known: self.reference.state().axis,
            slp: (switch.is_some() && reference.ax_safe, slp != Stop::None),
            demand: highest,
        };
        self.last = Some((seen.position, seen.nominal));
    }

    fn refer(&mut self, seen: &Seen, moving: bool) -> reference::Outputs {
        let near = u64::from(self.config.near.0);
        let at = |position: i64, place: i64| position.abs_diff(place) <= near;
        let mark = i64::from(self.config.mark);
        self.reference.step(&reference::Inputs {
            power_on: seen.power_on,
            check_cause: false,
            homed: seen.homed,
            own_matches: at(seen.position, self.saved),
            peer_matches: at(seen.peer, self.saved),
            own_at_mark: at(seen.position, mark),
            peer_at_mark: at(seen.peer, mark),
            confirm: seen.confirm,
            som: seen.som,
            unit: seen.unit,
            door_open: seen.door_open,
            moving,
            peer_checked: seen.peer_checked,
        })
    }
}

/// A position as the monitors count it; that of a spindle begins anew after many revolutions.
fn wrapped(tenths: i64) -> i32 {
    tenths as i32
}
