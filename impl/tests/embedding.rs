//! The example of the book, page "How to embed a monitor": a controller of one axis in one channel. The page shows what
//! stands between the marks; what stands outside runs it.

// ANCHOR: controller
use stillpoint_monitors::kernel::Position;
use stillpoint_monitors::sinumerik::axis::{
    Config, Exchange, Inputs, Local, Monitor, Outputs, Side, State,
};
use stillpoint_monitors::sinumerik::parameters::{ParameterError, Parameters};

/// One axis in one of its two channels.
pub struct Controller {
    monitor: Monitor,
    /// What the other channel told last.
    other: Exchange,
}

impl Controller {
    /// After power-on, with the machine data of the axis and what is kept through power-off.
    pub fn new(
        side: Side,
        data: &Parameters,
        agreed: bool,
        standstill: Option<Position>,
    ) -> Result<Self, ParameterError> {
        let config = Config::new(side, data.validate()?);
        // A state that breaks the invariant is refused; then the axis starts as delivered.
        let state = State::restored(agreed, standstill);
        let monitor = Monitor::resume(config, state).unwrap_or(Monitor::new(config));
        let other = Exchange::default();
        Ok(Self { monitor, other })
    }

    /// What came from the other channel since the last cycle.
    pub fn receive(&mut self, told: Exchange) {
        self.other = told;
    }

    /// One monitoring cycle: what this channel sees, and what it demands of drive and control.
    pub fn cycle(&mut self, local: Local) -> Outputs {
        let other = self.other;
        self.monitor.step(&Inputs { local, other })
    }
}
// ANCHOR_END: controller

use stillpoint_monitors::sinumerik::interface::Sge;
use stillpoint_monitors::sinumerik::level::Level;

/// An axis held in its safe operating stop: both inputs that would de-select it are 0.
fn held(position: i32) -> Local {
    Local {
        run_up: true,
        spl_started: true,
        sge: Sge::UNUSED,
        position: Position(position),
        ..Local::default()
    }
}

/// S840D-SBH-001, S840D-STOP-020, S840D-STOP-022: an axis that leaves its window is stopped in both channels, and its pulses
/// are cancelled at the latest when t_B is over.
#[test]
fn an_axis_that_leaves_its_window_is_stopped() {
    let data = Parameters {
        function_enable: 1, // SBH/SG
        ..Parameters::default()
    };
    let controller =
        |side| Controller::new(side, &data, false, None).expect("plausible machine data");
    let (mut nck, mut drive) = (controller(Side::Nck), controller(Side::Drive));
    let mut cycle = |local: Local| {
        let (one, two) = (nck.cycle(local), drive.cycle(local));
        nck.receive(two.exchange);
        drive.receive(one.exchange);
        [one.channel.stop.level, two.channel.stop.level]
    };
    cycle(Local {
        power_on: true,
        ..held(0)
    });
    for _ in 0..100 {
        assert_eq!(cycle(held(1_000)), [Level::None; 2]); // the window is 1 mm
    }
    assert_eq!(cycle(held(1_001)), [Level::B; 2]);
    let ends = (1..20).find(|_| cycle(held(1_001)) == [Level::A; 2]);
    assert_eq!(ends, Some(9)); // 100 ms in cycles of 12 ms
}

/// Machine data that the manual does not permit are refused.
#[test]
fn implausible_data_give_no_controller() {
    let data = Parameters {
        function_enable: 2, // SE without SBH/SG
        ..Parameters::default()
    };
    assert!(Controller::new(Side::Nck, &data, false, None).is_err());
}
