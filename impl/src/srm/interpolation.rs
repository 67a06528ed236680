//! F_INTERPOLATION (FC200): a velocity limit between 17 points, the envelope of F_ENDZONE.
//!
//! Readings: AMB-35 (between two points multiply first, divide toward zero, then add; the lower velocity where points have the
//! same X; V_0 below the first point, V_16 above the last), AMB-66 (17 points; the tables print 15 or 16). The arithmetic is that
//! of the DInt blocks: a product that is no DInt is an error, not a wrong limit (SRM-INTERP-008). On an error the limit is 0
//! (SRM-INTERP-007).

pub use crate::contract::Stateless as State;

fields! {
    /// The points of an envelope (F-UDT INTERP): distances in mm, velocities in mm/min. Points that are not needed repeat the last
    /// one that is (SRM-INTERP-001, SRM-INTERP-006, SRM-ENDZONE-003).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Curve {
        /// X_0 to X_15.
        pub x: [i32; 16],
        /// V_0 to V_15.
        pub v: [i32; 16],
        /// X_16.
        pub x_16: i32,
        /// V_16.
        pub v_16: i32,
    }
}

/// How many points there are.
pub const POINTS: usize = 17;

impl Curve {
    /// A curve of its points, X and V; the last one again for those that are missing, those beyond the seventeenth not at all.
    pub fn of(points: &[(i32, i32)]) -> Self {
        let mut curve = Self::default();
        let mut last = (0, 0);
        let mut given = points.iter();
        for (x, v) in curve.x.iter_mut().zip(&mut curve.v) {
            last = given.next().copied().unwrap_or(last);
            (*x, *v) = last;
        }
        (curve.x_16, curve.v_16) = given.next().copied().unwrap_or(last);
        curve
    }

    /// The point with this number, from 0: X and V; the last one for a greater number.
    pub const fn point(&self, number: usize) -> (i32, i32) {
        if number < self.x.len() {
            // `number` is below both lengths.
            #[allow(clippy::indexing_slicing)]
            (self.x[number], self.v[number])
        } else {
            (self.x_16, self.v_16)
        }
    }

    /// Its points in their order: X and V.
    pub const fn points(&self) -> [(i32, i32); POINTS] {
        let mut points = [(self.x_16, self.v_16); POINTS];
        let mut number = 0;
        while number < POINTS {
            // `number` is below the length.
            #[allow(clippy::indexing_slicing)]
            {
                points[number] = self.point(number);
            }
            number += 1;
        }
        points
    }

    /// No X is less than the one before (SRM-INTERP-002).
    pub const fn ascends(&self) -> bool {
        let mut number = 1;
        while number < POINTS {
            if self.point(number).0 < self.point(number - 1).0 {
                return false;
            }
            number += 1;
        }
        true
    }

    /// The limit at a place; none where the points do not ascend or the arithmetic overflows.
    pub fn limit(&self, place: i32) -> Option<i32> {
        if !self.ascends() {
            return None;
        }
        let (mut below, mut lowest, mut above) = (None, None, None);
        let mut number = 0;
        while number < POINTS {
            let point = self.point(number);
            if point.0 < place {
                below = Some(point);
            } else if point.0 > place {
                above = above.or(Some(point));
            } else {
                lowest = Some(lowest.map_or(point.1, |lowest: i32| lowest.min(point.1)));
            }
            number += 1;
        }
        match (below, lowest, above) {
            (_, Some(lowest), _) => Some(lowest),
            (None, None, outer) | (outer, None, None) => Some(outer?.1),
            (Some(below), None, Some(above)) => between(below, above, place),
        }
    }
}

/// The velocity at a place between two points; none where the arithmetic overflows.
fn between(below: (i32, i32), above: (i32, i32), place: i32) -> Option<i32> {
    let rise = above.1.checked_sub(below.1)?;
    let part = rise.checked_mul(place.checked_sub(below.0)?)?;
    let width = above.0.checked_sub(below.0)?;
    below.1.checked_add(part.checked_div(width)?)
}

config! {
    /// The points.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Config {
        /// The points.
        pub curve: Curve,
    }
    accepted |_config| true
}

fields! {
    /// The input of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Inputs {
        /// X_ACTUAL, the remaining distance, mm.
        pub x_actual: i32,
    }
}

fields! {
    /// The outputs of one call.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub struct Outputs {
        /// V_LIMIT, mm/min.
        pub v_limit: i32,
        /// ERROR: the points do not ascend, or the arithmetic has overflowed; there is no DIAG (SRM-DIAG-002).
        pub error: bool,
    }
}

/// Whether some point is as wanted.
fn some_point(curve: &Curve, wanted: impl Fn((i32, i32)) -> bool) -> bool {
    let mut some = false;
    let mut number = 0;
    while number < POINTS {
        some |= wanted(curve.point(number));
        number += 1;
    }
    some
}

/// The limit is less than 1 from the exact value on the line between two neighbours, on the side of the first of them; true of
/// places that are not strictly between two.
fn on_the_line(curve: &Curve, place: i32, limit: i32) -> bool {
    let mut segment = None;
    let mut number = 1;
    while number < POINTS {
        let (below, above) = (curve.point(number - 1), curve.point(number));
        if below.0 < place && place < above.0 {
            segment = Some((below, above));
        }
        number += 1;
    }
    // Points that ascend have a place between no other two.
    segment.is_none_or(|(below, above)| near_the_line(below, above, place, limit))
}

/// The same of a place that is between these two points.
fn near_the_line(below: (i32, i32), above: (i32, i32), place: i32, limit: i32) -> bool {
    // Without an error every difference and the product are DInt, so that nothing here leaves 64 bits.
    let (width, rise) = (
        above.0 as i64 - below.0 as i64,
        above.1 as i64 - below.1 as i64,
    );
    let exact = rise.saturating_mul(place as i64 - below.0 as i64);
    let left = exact.saturating_sub((limit as i64 - below.1 as i64).saturating_mul(width));
    left.abs() < width && (left == 0 || (left < 0) == (rise < 0))
}

monitor! { srm::interpolation;
    /// Points that do not ascend are an error.
    points_ascend ["SRM-INTERP-002"]:
        when |s| !s.config.curve.ascends()
            => s.outputs.error;

    /// On an error there is no velocity.
    error_permits_nothing ["SRM-INTERP-007"]:
        when |s| s.outputs.error
            => s.outputs.v_limit == 0;

    /// At a point its velocity is the limit.
    point_has_its_velocity ["SRM-INTERP-003", "SRM-P-27"]:
        when |s| !s.outputs.error && some_point(&s.config.curve, |point| point.0 == s.inputs.x_actual)
            => some_point(&s.config.curve, |point| point.0 == s.inputs.x_actual && s.outputs.v_limit == point.1);

    /// Of several points at one place the lowest velocity counts.
    lowest_of_a_place_counts ["SRM-INTERP-003"]:
        when |s| !s.outputs.error
            => !some_point(&s.config.curve, |point| point.0 == s.inputs.x_actual && s.outputs.v_limit > point.1);

    /// Between two points the limit is less than 1 mm/min from the line, toward the velocity of the point before.
    line_between_points ["SRM-INTERP-004", "SRM-ENDZONE-027", "SRM-P-27"]:
        when |s| !s.outputs.error
            && s.config.curve.point(0).0 < s.inputs.x_actual && s.inputs.x_actual < s.config.curve.x_16
            => on_the_line(&s.config.curve, s.inputs.x_actual, s.outputs.v_limit);

    /// Before the first point and behind the last one their velocities hold.
    ends_go_on ["SRM-INTERP-005", "SRM-ENDZONE-005"]:
        when |s| !s.outputs.error
            && (s.inputs.x_actual < s.config.curve.point(0).0 || s.config.curve.x_16 < s.inputs.x_actual)
            => s.outputs.v_limit == if s.inputs.x_actual < s.config.curve.point(0).0 {
                s.config.curve.point(0).1
            } else {
                s.config.curve.v_16
            };

    /// No limit is above the highest velocity of the points.
    never_above_the_points ["SRM-ENDZONE-005", "SRM-P-27"]:
        when |s| !s.outputs.error
            => some_point(&s.config.curve, |point| s.outputs.v_limit <= point.1);

    /// Nothing is an error where points ascend and each product of a segment is a DInt.
    no_error_without_a_cause ["SRM-INTERP-007", "SRM-INTERP-008"]:
        when |s| s.config.curve.ascends() && segments_fit(&s.config.curve)
            => !s.outputs.error;
}

/// Whether no segment can overflow: its width, its rise and their product are DInt.
pub fn segments_fit(curve: &Curve) -> bool {
    let mut fit = true;
    let mut number = 1;
    while number < POINTS {
        let (below, above) = (curve.point(number - 1), curve.point(number));
        let width = above.0.checked_sub(below.0);
        let product = match (width, above.1.checked_sub(below.1)) {
            (Some(width), Some(rise)) => width.checked_mul(rise),
            _ => None,
        };
        fit &= product.is_some();
        number += 1;
    }
    fit
}

pub(crate) fn transition(state: State, config: &Config, inputs: &Inputs) -> (State, Outputs) {
    let limit = config.curve.limit(inputs.x_actual);
    let outputs = Outputs {
        v_limit: limit.unwrap_or(0),
        error: limit.is_none(),
    };
    (state, outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(curve: Curve, x_actual: i32) -> (i32, bool) {
        let (_, outputs) = next(State::INITIAL, &Config { curve }, &Inputs { x_actual });
        (outputs.v_limit, outputs.error)
    }

    /// SRM-INTERP-003, SRM-INTERP-004, SRM-INTERP-005.
    #[test]
    fn points_lines_and_ends() {
        let curve = Curve::of(&[(0, 0), (10, 100), (13, 200), (40, 240)]);
        assert_eq!(at(curve, -1), (0, false));
        assert_eq!(at(curve, 0), (0, false));
        assert_eq!(at(curve, 5), (50, false));
        assert_eq!(at(curve, 10), (100, false));
        assert_eq!(at(curve, 11), (133, false), "133.33 toward zero");
        assert_eq!(at(curve, 40), (240, false));
        assert_eq!(at(curve, 41), (240, false));
    }

    /// A segment that falls is rounded toward the point before: up (P-27).
    #[test]
    fn a_falling_segment_is_rounded_up() {
        let curve = Curve::of(&[(0, 10), (3, 0)]);
        assert_eq!(at(curve, 1), (7, false), "6.67");
    }

    /// SRM-INTERP-002, SRM-INTERP-003.
    #[test]
    fn equal_places_have_the_lower_velocity_and_falling_ones_are_an_error() {
        assert_eq!(
            at(Curve::of(&[(0, 0), (5, 70), (5, 50), (9, 90)]), 5),
            (50, false)
        );
        assert_eq!(at(Curve::of(&[(0, 0), (5, 70), (4, 50)]), 1), (0, true));
    }

    /// SRM-INTERP-008: 240000 mm/min over 10000 mm overflows where the place is far in the segment.
    #[test]
    fn a_product_that_is_no_dint_is_an_error() {
        let curve = Curve::of(&[(0, 0), (10_000, 240_000)]);
        assert!(!segments_fit(&curve));
        assert_eq!(at(curve, 1), (24, false));
        assert_eq!(at(curve, 8_947), (214_728, false));
        assert_eq!(at(curve, 8_948), (0, true));
        assert_eq!(at(curve, 10_000), (240_000, false));
    }
}
