//! How far a crane goes and how fast it still is before an end, computed here from the values of its file at each millimetre, not at the points of
//! its envelope: the guarantees hold from there on and not before.

use stillpoint_machine::{self as machine, families};
use stillpoint_tests::guarantees::is_violated;
use stillpoint_tests::root;

const CRANE: &str = "spec/machines/storage-crane.toml";

/// The calls in which the counter of the telegram may stand: 12 ms in 20 ms, rounded up, and one more.
const STANDS: f64 = 2.0;

/// From the call that finds it to the drive that brakes, in seconds: cycle of the drive, `signal`, cycle of the program, calls in which the
/// counter stands, runtime, delay.
const DEAD: f64 = 0.012 + 0.020 + CYCLE + STANDS * CYCLE + 0.007 + 0.100;

/// The cycles of the drive in 60 ms, from one value of the counter to the next, of which its velocity is the mean.
const MEAN: f64 = 0.060;

/// How hard the axis accelerates until the drive brakes, mm/s2.
const GAIN: f64 = 500.0;

/// T_SAMPLE, s.
const CYCLE: f64 = 0.020;

/// V_DISC_WINDOW in each V_SYNC_INTERVALL, mm/s: so much farther the axis may go than the encoder of its motor tells.
const SLIP: f64 = 20.0 / 1.0;

/// The intervals in which it does so beside those that the way takes: it may have drifted the other way before, which counts twice, and
/// the last one has only begun.
const MORE: f64 = 3.0 * 1.0;

/// What the ways depend on, in mm and mm/s.
struct Axis {
    points: Vec<(f64, f64)>,
    /// Of the ramp, mm/s2.
    braking: f64,
    /// SBR_MAXTOL_POS, and how wrong the safe position may be.
    off: f64,
    /// SBR_MAXTOL_V.
    faster: f64,
}

impl Axis {
    fn new(file: &toml::Table, name: &str, off: f64) -> Self {
        let axis = file["axis"][name].as_table().expect("an axis");
        let number = |value: &toml::Value| -> f64 {
            let text = value.as_str().expect("a text");
            let (number, _) = text.split_once(' ').expect("a unit");
            number.parse().expect("a number")
        };
        let list = |key: &str| -> Vec<f64> {
            let values = axis[key].as_array().expect("a list");
            values.iter().map(number).collect()
        };
        let speeds = list("EZ_V").into_iter().map(|v| v / 60.0);
        let default = |key: &str, otherwise: f64| axis.get(key).map_or(otherwise, number);
        Self {
            points: list("EZ_X").into_iter().zip(speeds).collect(),
            braking: number(&axis["SBR_V_MAX"]) / 60.0 / number(&axis["SBR_T_RAMP"]),
            off,
            faster: default("SBR_MAXTOL_V", 10_000.0) / 60.0,
        }
    }

    /// What the envelope permits at a remaining distance; where points repeat themselves, the first one.
    fn permitted(&self, distance: f64) -> f64 {
        let pairs = self.points.windows(2);
        let mut between = pairs.filter(|p| p[0].0 < distance && distance <= p[1].0);
        let Some([(x, v), (next, w)]) = between.next() else {
            let (_, last) = self.points[self.points.len() - 1];
            return if distance <= 0.0 { 0.0 } else { last };
        };
        v + (w - v) * (distance - x) / (next - x)
    }

    /// How far it goes from one velocity until the ramp, and with it the axis, is down to the other one.
    fn way(&self, from: f64, to: f64) -> f64 {
        let late = DEAD + MEAN;
        let fast = from + GAIN * late;
        let time = late + (fast - to).max(0.0) / self.braking;
        let told =
            (from + fast) / 2.0 * late + (fast * fast - to * to).max(0.0) / (2.0 * self.braking);
        told + self.off + SLIP * (MORE + time)
    }

    /// Every remaining distance up to beyond the last point, and the velocity there.
    fn everywhere(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        (1..20_000).map(|mm| (f64::from(mm), self.permitted(f64::from(mm))))
    }

    fn beyond(&self) -> f64 {
        let ways = self.everywhere().map(|(x, v)| self.way(v, 0.0) - x);
        ways.fold(0.0, f64::max)
    }

    /// The least velocity to which it is down, wherever it was found, before this distance; in mm/min.
    fn speed(&self, distance: f64) -> f64 {
        let kept = |speed: &u32| {
            let slow = (f64::from(*speed) / 60.0 - SLIP).max(0.0);
            let down = (slow - self.faster).max(0.0);
            let calm = slow - GAIN * (DEAD + MEAN);
            self.everywhere()
                .all(|(x, v)| v <= calm || self.way(v, down) <= x - distance)
        };
        (0..300_000)
            .step_by(10)
            .find(kept)
            .map(f64::from)
            .expect("a velocity")
    }
}

/// Whether the guarantee of the crane is violated with another text in its file.
fn violated(text: &str, from: &str, to: String, name: &str) -> bool {
    let path = root().join(CRANE);
    assert!(text.contains(from), "{from}");
    let text = text.replacen(from, &to, 1);
    let machine = machine::load_bytes(&path, text.into_bytes(), &families(&path))
        .unwrap_or_else(|e| panic!("{to}: {e}"));
    is_violated(&path, &machine, name)
}

#[test]
fn a_crane_stops_where_its_values_say_and_is_as_fast_as_they_say() {
    let text = std::fs::read_to_string(root().join(CRANE)).expect("the crane");
    let file: toml::Table = text.parse().expect("TOML");
    // SBR_MAXTOL_POS; two windows, POS_STARTUP_TOL and the slip of two encoders, the window of POS2 and a millimetre of three; half a step
    // of the ramp.
    let travel = Axis::new(
        &file,
        "X",
        80.0 + 2.0 * 50.0 + 10.0 + 30.0 + 4000.0 * CYCLE / 2.0,
    );
    let hoist = Axis::new(&file, "Y", 200.0 + 20.0 + 1.0 + 1000.0 * CYCLE / 2.0);
    for (axis, from, name) in [
        (&travel, "beyond  = \"1550 mm\"", "aisle"),
        (&hoist, "beyond  = \"600 mm\"", "mast"),
    ] {
        let least = axis.beyond().ceil();
        let with = |mm: f64| violated(&text, from, format!("beyond = \"{mm} mm\""), name);
        assert!(!with(least + 1.0), "{name}: {least} mm and 1 mm");
        assert!(with(least - 1.0), "{name}: {least} mm less 1 mm");
    }
    let least = travel.speed(100.0);
    let with = |speed: f64| {
        let speed = format!("speed = \"{speed} mm/min\"");
        violated(&text, "speed    = \"87000 mm/min\"", speed, "transfer")
    };
    // Ways are whole millimetres there.
    assert!(!with(least + 150.0), "{least} mm/min and 150");
    assert!(with(least - 150.0), "{least} mm/min less 150");
}

/// Where an envelope begins flat the axis gets nearest to the buffer before its first point that permits motion.
#[test]
fn a_crane_stops_before_the_first_point_too() {
    let text = std::fs::read_to_string(root().join(CRANE)).expect("the crane");
    let line = |text: &str, key: &str, first: &str, then: &str| -> String {
        let at = text.find(key).expect("the key");
        let end = at + text[at..].find('\n').expect("a line");
        let rest = format!(", \"{then}\"").repeat(16);
        format!("{}{key} = [\"{first}\"{rest}]{}", &text[..at], &text[end..])
    };
    let text = line(&text, "EZ_X ", "0 mm", "3000 mm");
    let text = line(&text, "EZ_V ", "0 mm/min", "6000 mm/min");
    let file: toml::Table = text.parse().expect("TOML");
    let travel = Axis::new(
        &file,
        "X",
        80.0 + 2.0 * 50.0 + 10.0 + 30.0 + 4000.0 * CYCLE / 2.0,
    );
    let least = travel.beyond().ceil();
    let from = "beyond  = \"1550 mm\"";
    let with = |mm: f64| violated(&text, from, format!("beyond = \"{mm} mm\""), "aisle");
    assert!(!with(least + 1.0), "{least} mm and 1 mm");
    assert!(with(least - 1.0), "{least} mm less 1 mm");
}

/// Behind the end of its range, where SLP finds it, an axis may be as fast as V_MAX.
#[test]
fn an_axis_with_slp_stops_where_its_values_say() {
    let text = "family = \"srm-fblocks\"\n[control]\nRUNTIME = \"7 ms\"\n[axis.X]\nkind = \"linear\"\nfunctions = [\"safe position\", \"SLP\", \"ramp\"]\n\
                V_MAX = \"30000 mm/min\"\nSBR_V_MAX = \"30000 mm/min\"\nSBR_T_RAMP = \"1 s\"\nSBR_MAXTOL_V = \"3000 mm/min\"\n\
                SBR_MAXTOL_POS = \"100 mm\"\nX_NEGATIVE = \"1000 mm\"\nX_POSITIVE = \"99000 mm\"\n\
                [guarantee.stops]\npattern = \"stops_in_time\"\naxes = [\"X\"]\nbeyond = \"900 mm\"\nsignal = \"20 ms\"\ndelay = \"100 ms\"\nacceleration = \"500 mm/s2\"\nslipped = \"0 mm\"\n";
    // It is known to be no faster than V_MAX by its mean only.
    let late = DEAD + MEAN;
    let fast = 500.0 + GAIN * late;
    let (way, off) = (
        (500.0 + fast) / 2.0 * late + fast * fast / 1000.0,
        100.0 + 110.0 + 500.0 * CYCLE / 2.0 + SLIP * (MORE + late + fast / 500.0),
    );
    let with = |mm: f64| {
        let beyond = format!("beyond = \"{mm} mm\"");
        violated(text, "beyond = \"900 mm\"", beyond, "stops")
    };
    assert!(!with((way + off).round() + 1.0));
    assert!(with((way + off).round() - 1.0));
    // A buffer behind the last position that is permitted is no way to stop on.
    let near = text.replace("X_NEGATIVE = \"1000 mm\"", "X_NEGATIVE = \"500 mm\"");
    assert!(violated(&near, "900 mm", "900 mm".into(), "stops"));
}
