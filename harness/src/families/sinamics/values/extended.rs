//! The values of the Extended Functions.

use stillpoint_monitors::kernel::{Distance, Percent, Speed};
use stillpoint_monitors::sinamics::control_path::ControlPath;
use stillpoint_monitors::sinamics::sdi::Permitted;
use stillpoint_monitors::sinamics::types::{Braking, Stop};
use stillpoint_monitors::sinamics::{
    acceptance_mode, actual_value, cross_check, gear, sam, sbr, sdi, setpoint_limit, slp, sls,
    sls_ramp, sos, ss1, ss2, ssm, stop_arbiter,
};

use super::service::TOLERANT_US;
use super::{
    APART, BY_TELEGRAM, BrakingMonitor, Extended, GEAR, Reader, SDI, SLP, SP, cycle_us, enables,
    encoder, referenced,
};
use crate::families::values::{Fit, cell, fit};

impl Reader<'_> {
    pub(super) fn extended(&self) -> Fit<Extended> {
        let has = |function| self.axis.has(function);
        let kind = match self.cell("p9506") {
            0 => Braking::EncoderSam,
            1 => Braking::BareSbr,
            2 => Braking::EncoderSbr,
            _ => Braking::BareSam,
        };
        let encoder = kind.encoder();
        let external = self.is("p9507_3");
        let hysteresis = has("SSM hysteresis");
        let [b, c, d, e, f] =
            ["p9556", "p9552", "p9553", "p9554", "p9555"].map(|name| self.time(name));
        let limits = [0, 1, 2, 3].map(|k| self.speed("p9531", k));
        let unselected = enables(self.axis, ControlPath::without_selection);
        let always = ["p9512_4", "p9512_12", "p9512_13"].map(|name| unselected && self.is(name));
        let mut responses = [Stop::None; 4];
        for (k, response) in responses.iter_mut().enumerate() {
            *response = self.stop("p9563", k)?;
        }
        let sls = sls::Config::new(
            limits,
            responses,
            self.time("p9551"),
            encoder,
            has(BY_TELEGRAM),
            always[0],
            Default::default(),
        );
        let shutdown = self.speed("p9560", 0);
        let percent = u8::try_from(self.cell("p9533")).unwrap_or(100);
        let factor = fit("p9533", Percent::new(percent))?;
        let setpoint = setpoint_limit::Config::new(factor, 1, 1, self.is("p9507_1"));
        let slip = Distance(self.speed("p9549", 0).0);
        let synchronised = has("actual value synchronisation");
        let factor = u16::try_from(self.cell("p9543")).unwrap_or(u16::MAX);
        let p9542 = self.distance("p9542");
        let actual = match has(SLP) || has(SP) {
            true => actual_value::Config::with_position(p9542, slip, synchronised, factor),
            false => actual_value::Config::new(p9542, slip, synchronised, factor),
        };
        let arbiter = stop_arbiter::Config::new(b, c, d, e, f, external, hysteresis);
        let ssm = ssm::Config::new(
            self.speed("p9546", 0),
            hysteresis.then(|| self.speed("p9547", 0)),
            encoder,
            !self.is("p9509_0"),
        );
        let codes = |name, k| cell(&self.axis.values, name, k);
        Ok(Extended {
            acceptance: acceptance_mode::Config::new(self.time("p9558")).ok(),
            check: fit("the cross-check", cross_check::Config::new(APART))?,
            arbiter: fit("p9552 to p9556", arbiter)?,
            ss1: fit(
                "p9556 and p9560",
                ss1::Config::new(b, shutdown, kind, external, Default::default()),
            )?,
            ss2: match encoder {
                true => {
                    let config = ss2::Config::new(c, d, e, kind, Default::default());
                    Some(fit("p9552 to p9554", config)?)
                }
                false => None,
            },
            sos: sos::Config {
                delay: self.time("p9551"),
                tolerance: self.distance("p9530"),
            },
            sls: fit("p9531 and p9563", sls)?,
            sls_ramp: match kind == Braking::BareSbr && !unselected {
                true => {
                    let ramp =
                        sls_ramp::Config::new(limits, responses, self.ramp()?, has(BY_TELEGRAM));
                    Some(fit("p9531 and p9563", ramp)?)
                }
                false => None,
            },
            reference: match referenced(self.axis) {
                true => Some(self.reference()?),
                false => None,
            },
            gear: match has(GEAR) {
                true => Some(fit(
                    "the 2 min",
                    gear::Config::new(self.within(TOLERANT_US)),
                )?),
                false => None,
            },
            position: match has(SP) {
                true => Some(self.transferred()?),
                false => None,
            },
            bare: match encoder {
                true => None,
                false => Some(self.bare(unselected)?),
            },
            unselected: always,
            encoder_stop: self.encoder_stop(),
            sls_codes: [0, 1, 2, 3].map(|k| codes("p9563", k)),
            sdi: match has(SDI) {
                true => Some([
                    self.sdi(Permitted::Positive, always[1])?,
                    self.sdi(Permitted::Negative, always[2])?,
                ]),
                false => None,
            },
            sdi_code: codes("p9566", 0),
            slp: match has(SLP) {
                true => Some(self.slp()?),
                false => None,
            },
            slp_codes: [0, 1].map(|k| codes("p9562", k)),
            ssm: fit("p9546 and p9547", ssm)?,
            braking: self.braking(kind)?,
            actual: fit("p9543", actual)?,
            setpoint: match percent {
                0 => None,
                _ => Some(fit("p9533", setpoint)?),
            },
            shutdown,
            limits,
        })
    }

    fn sdi(&self, permitted: Permitted, unselected: bool) -> Fit<sdi::Config> {
        let config = sdi::Config::new(
            permitted,
            self.time("p9565"),
            self.distance("p9564"),
            self.stop("p9566", 0)?,
            encoder(self.axis),
            unselected,
            self.is("p9509_8"),
            Default::default(),
        );
        fit("p9566", config)
    }

    fn slp(&self) -> Fit<slp::Config> {
        let range = |k| -> Fit<slp::Range> {
            Ok(slp::Range {
                lower: self.position("p9535", k),
                upper: self.position("p9534", k),
                response: self.stop("p9562", k)?,
            })
        };
        fit(
            "p9534, p9535 and p9562",
            slp::Config::new(range(0)?, range(1)?),
        )
    }

    fn ramp(&self) -> Fit<sbr::Config> {
        let config = sbr::Config::new(
            self.speed("p9581", 0),
            self.time("p9583"),
            self.time("p9582"),
            Speed(1),
            Default::default(),
            Default::default(),
        );
        fit("p9583", config)
    }

    fn encoder_stop(&self) -> Stop {
        match self.is("p9516_4") {
            true => Stop::B,
            false => Stop::A,
        }
    }

    fn braking(&self, kind: Braking) -> Fit<BrakingMonitor> {
        if kind.ramp() {
            return Ok(BrakingMonitor::Sbr(self.ramp()?));
        }
        // p9511 = 0: 1 ms, there is no isochronous bus here.
        let acquisition = u32::try_from(self.cell("p9511")).unwrap_or(0);
        let acquisition = if acquisition == 0 { 1_000 } else { acquisition };
        let ratio = u8::try_from(cycle_us(self.machine) / acquisition).unwrap_or(u8::MAX);
        let config = sam::Config::new(
            self.speed("p9548", 0),
            ratio.max(1),
            self.speed("p9568", 0),
            self.speed("p9546", 0),
            self.encoder_stop(),
            Default::default(),
            Default::default(),
        );
        Ok(BrakingMonitor::Sam(fit("p9548 and p9511", config)?))
    }
}
