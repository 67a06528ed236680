//! Conversion of checked machine data into the configurations of the monitors.

use core::num::NonZeroU32;

use super::{ControlModule, Encoders, Function, ParameterError, Parameters};
use crate::kernel::{ConfigError, Cycles, Distance, Percent, Position, Speed};
use crate::sinumerik::compare::list;
use crate::sinumerik::encoder::LimitFrequency;
use crate::sinumerik::{
    agreement, bus_failure, cam, channel, compare, external, fault, forced_check, gear, group,
    history, limit_switch, pulses, ramp, reference, results, selection, setpoint, shutdown_test,
    slip, speed, standstill, stop, test_stop, threshold,
};
use crate::units::{ModuloRange, Scale};

/// The user agreements may differ this long (S840D-UA-009).
const AGREEMENTS_DIFFER: u32 = 2_000_000;

/// The cycles from one comparison of the positions to the next: one item of the list is compared in each (MD36992).
#[allow(clippy::cast_possible_truncation)]
const PASS: u32 = list::ITEMS.len() as u32;

/// The configurations of all monitors of one channel of one axis, from machine data that the manual permits: there is no
/// way to one but [`Parameters::validate`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Configuration {
    pub(crate) cycle_us: NonZeroU32,
    pub(crate) channel: channel::Config,
    pub(crate) cams: [cam::Config; 8],
    pub(crate) gear: gear::Config,
    pub(crate) agreement: agreement::Config,
    pub(crate) reference: reference::Config,
    pub(crate) history: history::Config,
    pub(crate) slip: Option<slip::Config>,
    pub(crate) results: results::Config,
    pub(crate) compare: compare::Config,
    pub(crate) tolerance: list::Tolerance,
    /// By how much the ways of one cycle may differ where both channels compare theirs with n_x.
    pub(crate) speed_tolerance: Distance,
    pub(crate) modulo: ModuloRange,
    pub(crate) shutdown_test: shutdown_test::Config,
    pub(crate) forced_check: forced_check::Config,
    pub(crate) group: group::Config,
    pub(crate) setpoint: setpoint::Config,
    pub(crate) bus_nck: bus_failure::Config,
    pub(crate) bus_drive: bus_failure::Config,
    pub(crate) words: list::Parameters,
    pub(crate) park_alarm_suppress: bool,
}

macro_rules! shown {
    ($($(#[$doc:meta])+ $field:ident: $type:ty;)+) => {
        impl Configuration {
            $($(#[$doc])+ pub const fn $field(&self) -> &$type { &self.$field })+
        }
    };
}

shown! {
    /// The monitors of the channel.
    channel: channel::Config;
    /// The cams SN1+, SN1-, SN2+ to SN4-.
    cams: [cam::Config; 8];
    /// The gear stage.
    gear: gear::Config;
    /// The user agreement.
    agreement: agreement::Config;
    /// Referencing.
    reference: reference::Config;
    /// The comparison with the stored position.
    history: history::Config;
    /// The synchronisation of the actual values, where it is enabled.
    slip: Option<slip::Config>;
    /// The result lists.
    results: results::Config;
    /// The cross comparison.
    compare: compare::Config;
    /// The test of the external shutdown.
    shutdown_test: shutdown_test::Config;
    /// The interval of the tests.
    forced_check: forced_check::Config;
    /// The effect of its stops on other axes.
    group: group::Config;
    /// The limit of the speed setpoint.
    setpoint: setpoint::Config;
    /// The NCK's reaction to a failure of the drive bus.
    bus_nck: bus_failure::Config;
    /// The drive's reaction to it.
    bus_drive: bus_failure::Config;
    /// The parameters as they are compared with the other channel.
    words: list::Parameters;
}

/// The conversions that depend on the monitoring cycle.
#[derive(Clone, Copy)]
struct Clock {
    cycle_us: NonZeroU32,
    scale: Scale,
}

impl Clock {
    fn new(p: &Parameters) -> Result<Self, ConfigError> {
        let cycle_us = u32::try_from(p.monitoring_cycle_us())
            .ok()
            .and_then(NonZeroU32::new)
            .ok_or(ConfigError::CycleTooLong)?;
        Ok(Self {
            cycle_us,
            scale: Scale::new(p.axis(), cycle_us)?,
        })
    }

    /// A delay of microseconds, rounded up once.
    fn delay(self, micros: u32) -> Result<Cycles, ConfigError> {
        Cycles::from_micros_up(micros.into(), self.cycle_us).map_err(|_| ConfigError::DelayTooLong)
    }

    /// The time in which something must be repeated, in microseconds, rounded down.
    fn interval(self, micros: u64) -> Result<Cycles, ConfigError> {
        Cycles::from_micros_down(micros, self.cycle_us).map_err(|_| ConfigError::DelayTooLong)
    }

    /// A speed in thousandths of mm/min or rev/min, rounded down.
    fn speed(self, thousandths: u32) -> Result<Speed, ConfigError> {
        self.scale.speed_from_thousandths(u64::from(thousandths))
    }

    /// The greatest difference of the actual values that a tolerated slip, in thousandths of mm/min or rev/min, leaves after
    /// a number of cycles (S840D-SLIP-504): the slip of these cycles, rounded up, and the dead band, which covers what stays
    /// uncorrected and what is lost where each channel rounds its own position. A slip up to the machine datum is so never
    /// an error; what is tolerated beyond it is less than three increments in these cycles.
    fn slip(self, thousandths: u32, cycles: u32) -> Result<Distance, ConfigError> {
        let way = self.scale.way_up(thousandths, cycles)?;
        Ok(Distance(way.0.saturating_add(slip::DEAD_BAND.0)))
    }

    fn speeds(self, [a, b, c, d]: [u32; 4]) -> Result<[Speed; 4], ConfigError> {
        Ok([
            self.speed(a)?,
            self.speed(b)?,
            self.speed(c)?,
            self.speed(d)?,
        ])
    }
}

#[cfg(feature = "mutants")]
impl Configuration {
    /// The same for an exploration of both channels, with two constants of the manual made small: `items`, the list of the
    /// comparison, usually [`list::CLASSES`]; `t_differ`, how long the user agreements may differ.
    ///
    /// # Errors
    /// Those of [`compare::Config::new`] and [`agreement::Config::new`].
    pub fn shortened(
        self,
        items: &'static [list::Item],
        t_differ: Cycles,
    ) -> Result<Self, ConfigError> {
        Ok(Self {
            compare: compare::Config::new(self.compare.t_chg(), items)?,
            agreement: agreement::Config::new(t_differ, self.channel.se_sn_enabled)?,
            ..self
        })
    }
}

impl Configuration {
    /// The monitoring cycle T_SI in us.
    pub const fn cycle_us(&self) -> NonZeroU32 {
        self.cycle_us
    }

    /// How long one pass of the comparison takes, in us (MD36992): one item in each monitoring cycle (S840D-PARAM-004).
    pub fn comparison_us(&self) -> u64 {
        // A list has fewer than 256 items.
        u64::try_from(self.compare.pass())
            .unwrap_or(u64::MAX)
            .saturating_mul(u64::from(self.cycle_us.get()))
    }

    /// The longest pass of several axes, in us (MD10092); 0 without an axis (S840D-PARAM-004).
    pub fn longest_comparison_us(axes: &[Self]) -> u64 {
        axes.iter().map(Self::comparison_us).max().unwrap_or(0)
    }

    pub(super) fn convert(p: &Parameters) -> Result<Self, ParameterError> {
        let clock = Clock::new(p)?;
        let se_sn_enabled = p.se_sn_enabled();
        let slip_tol = clock.slip(p.slip_velo_tol, PASS)?;
        let slip = if p.enabled(Function::SlipSync) {
            let two = p.installation.encoders == Encoders::Two;
            Some(slip::Config::new(
                slip::DEAD_BAND,
                slip_tol,
                two,
                se_sn_enabled,
            )?)
        } else {
            None
        };
        let mut enabled_cams = [false; 8];
        for (cam, enabled) in (0..8).zip(&mut enabled_cams) {
            *enabled = p.cam_enabled(cam);
        }
        let modulo = p.modulo_range()?;
        Ok(Self {
            cycle_us: clock.cycle_us,
            channel: channel(p, clock)?,
            cams: cams(p)?,
            gear: gear::Config::new(p.installation.gear_max, se_sn_enabled)?,
            agreement: agreement::Config::new(clock.delay(AGREEMENTS_DIFFER)?, se_sn_enabled)?,
            reference: reference::Config::new(se_sn_enabled)?,
            history: history::Config::new(Distance(p.refp_pos_tol))?,
            slip,
            results: results::Config::new(enabled_cams, p.velo_x > 0, modulo.folds())?,
            compare: compare::Config::new(clock.delay(p.mode_switch_time)?, &list::ITEMS)?,
            tolerance: if slip.is_some() {
                list::Tolerance::Slip(slip_tol)
            } else {
                list::Tolerance::Position(Distance(p.pos_tol))
            },
            speed_tolerance: if slip.is_some() {
                clock.slip(p.slip_velo_tol, 1)?
            } else {
                Distance(p.pos_tol)
            },
            modulo,
            shutdown_test: shutdown_test::Config::new(clock.delay(p.pulse_dis_check_time)?)?,
            forced_check: forced_check::Config::new(clock.interval(p.installation.test_interval)?)?,
            group: group::Config::new(if p.ipo_stop_group == 0 {
                group::Reach::Channel
            } else {
                group::Reach::Interpolating
            }),
            setpoint: setpoint::Config::new(p.des_velo_limit)?,
            bus_nck: bus_failure(p, clock, true)?,
            bus_drive: bus_failure(p, clock, false)?,
            words: words(p, clock)?,
            park_alarm_suppress: p.park_alarm_suppress,
        })
    }
}

fn channel(p: &Parameters, clock: Clock) -> Result<channel::Config, ConfigError> {
    let t_chk = clock.delay(p.pulse_dis_check_time)?;
    let velo_x = clock.speed(p.velo_x)?;
    // In pulses per cycle: the same in every gear stage.
    let encoder_max = match p.installation.encoders {
        Encoders::One => {
            let extended = p.installation.module == ControlModule::High;
            let limit = LimitFrequency::new(p.enc_freq_limit, extended)?;
            Some(limit.pulses_per_cycle(clock.cycle_us)?)
        }
        Encoders::Two => None,
    };
    let selection = selection::Config::new(
        p.enabled(Function::SbhSg),
        clock.delay(p.velo_switch_delay)?,
        clock.speeds(p.velo_limit)?,
    )?;
    Ok(channel::Config {
        external: external::Config::new(
            p.enabled(Function::ExternalStops),
            p.enabled(Function::StopE),
            p.spl_stop_mode == 4 && p.function_enable != 0,
        )?,
        test: test_stop::Config::new(t_chk)?,
        selection: if p.enabled(Function::Override) {
            selection.with_override(p.velo_ovr_factor)?
        } else {
            selection
        },
        standstill: standstill::Config::new(Distance(p.standstill_tol))?,
        speed: speed::Config::new(p.velo_stop_mode, p.velo_stop_reaction, encoder_max)?,
        limit_switch: limit_switch::Config::new(
            p.enabled(Function::Se),
            p.pos_limit_plus.map(Position),
            p.pos_limit_minus.map(Position),
            p.pos_stop_mode,
        )?,
        ramp: ramp::Config::new(velo_x, clock.speed(p.stop_velo_tol)?)?,
        threshold: threshold::Config::new(velo_x)?,
        fault: fault::Config::new(clock.delay(p.stop_switch_time_f)?)?,
        stop: stop::Config::new(
            clock.delay(p.pulse_disable_delay)?,
            clock.delay(p.stop_switch_time_c)?,
            clock.delay(p.stop_switch_time_d)?,
            clock.delay(p.stop_switch_time_e)?,
        )?,
        pulses: pulses::Config::new(
            p.installation.internal_cancellation,
            p.installation.external_path,
            t_chk,
        )?,
        standstill_speed: clock.speed(p.standstill_velo_tol)?,
        se_sn_enabled: p.se_sn_enabled(),
    })
}

fn bus_failure(
    p: &Parameters,
    clock: Clock,
    nck: bool,
) -> Result<bus_failure::Config, ConfigError> {
    bus_failure::Config::new(
        nck,
        p.enabled(Function::SbhSg),
        // Rounded down: at its end the pulses must be off.
        clock.interval(p.pulse_dis_time_busfail.into())?,
        p.velo_stop_mode,
        p.velo_stop_reaction,
    )
}

fn cams(p: &Parameters) -> Result<[cam::Config; 8], ConfigError> {
    let range = p.modulo_range()?;
    let cam = |cam| {
        cam::Config::new(
            p.cam_enabled(cam),
            Position(p.cam_position(cam)),
            Distance(p.cam_tol),
            p.enabled(Function::CamSync),
            range,
            Distance(p.pos_tol),
        )
    };
    Ok([
        cam(0)?,
        cam(1)?,
        cam(2)?,
        cam(3)?,
        cam(4)?,
        cam(5)?,
        cam(6)?,
        cam(7)?,
    ])
}

fn factors(p: &Parameters) -> Result<[Percent; 16], ConfigError> {
    let mut factors = [Percent::WHOLE; 16];
    for (factor, percent) in factors.iter_mut().zip(p.velo_ovr_factor) {
        *factor = Percent::new(percent)?;
    }
    Ok(factors)
}

/// The parameters as they are compared: the values of the channel itself, so that also its conversion is compared.
fn words(p: &Parameters, clock: Clock) -> Result<list::Parameters, ConfigError> {
    let pair = |index: u8| list::CamPair {
        plus: Position(p.cam_position(2 * index)),
        minus: Position(p.cam_position(2 * index + 1)),
    };
    Ok(list::Parameters {
        function_enable: p.function_enable,
        velo_limit: clock.speeds(p.velo_limit)?,
        standstill_tol: Distance(p.standstill_tol),
        pos_limit_plus: p.pos_limit_plus.map(Position),
        pos_limit_minus: p.pos_limit_minus.map(Position),
        cams: [pair(0), pair(1), pair(2), pair(3)],
        cam_tol: Distance(p.cam_tol),
        pos_tol: Distance(p.pos_tol),
        slip_velo_tol: clock.slip(p.slip_velo_tol, PASS)?,
        refp_pos_tol: Distance(p.refp_pos_tol),
        velo_switch_delay: clock.delay(p.velo_switch_delay)?,
        mode_switch_time: clock.delay(p.mode_switch_time)?,
        pulse_disable_delay: clock.delay(p.pulse_disable_delay)?,
        pulse_dis_check_time: clock.delay(p.pulse_dis_check_time)?,
        stop_switch_time: [
            clock.delay(p.stop_switch_time_c)?,
            clock.delay(p.stop_switch_time_d)?,
            clock.delay(p.stop_switch_time_e)?,
        ],
        velo_stop_mode: p.velo_stop_mode,
        pos_stop_mode: p.pos_stop_mode,
        standstill_velo_tol: clock.speed(p.standstill_velo_tol)?,
        velo_ovr_factor: factors(p)?,
        velo_x: clock.speed(p.velo_x)?,
        velo_stop_reaction: p.velo_stop_reaction,
        modulo_range: Distance(p.modulo_range),
        stop_velo_tol: clock.speed(p.stop_velo_tol)?,
        acceptance_tst_timeout: clock.delay(p.acceptance_tst_timeout)?,
        stop_switch_time_f: clock.delay(p.stop_switch_time_f)?,
        pulse_dis_time_busfail: clock.delay(p.pulse_dis_time_busfail)?,
        enc_freq_limit: p.enc_freq_limit,
    })
}
