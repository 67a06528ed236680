//! The axes that share an output "enable pulses externally" (MD36984), and with it the test of the external shutdown.
//!
//! The test is selected at one axis of an output and runs at every axis of it (S840D-TEST-018): each shows message 27006,
//! expects the feedback of its own drive within t_chk, and answers for itself with code 1010. So the dead wiring of one
//! terminal is found whichever axis the test was selected at, and the sound ones do not hide it.
//!
//! The NCK calls [`selected`] before the cycle of its axes, with their selections of this cycle, and [`enabled`] after it.

/// An output as MD36984 names it. 0 is none: such an axis stands for itself.
pub type Output = u32;

/// Whether the test runs at each axis: [`Local::shutdown_test_select`](crate::sinumerik::axis::Local::shutdown_test_select).
///
/// `outputs`: the output of each axis. `selections`: the signal "test stop external shutdown" of each axis.
pub fn selected<const AXES: usize>(
    outputs: &[Output; AXES],
    selections: &[bool; AXES],
) -> [bool; AXES] {
    spread(outputs, selections, true)
}

/// What the terminals of each axis receive: enabled only while every axis of the output enables (S840D-PULSE-008).
///
/// `enables`: "enable pulses externally" of each axis, [`pulses::Outputs`](crate::sinumerik::pulses::Outputs).
pub fn enabled<const AXES: usize>(
    outputs: &[Output; AXES],
    enables: &[bool; AXES],
) -> [bool; AXES] {
    spread(outputs, enables, false)
}

/// The values with `dominant` spread from each axis to every axis of its output.
fn spread<const AXES: usize>(
    outputs: &[Output; AXES],
    values: &[bool; AXES],
    dominant: bool,
) -> [bool; AXES] {
    let mut results = *values;
    for (result, output) in results.iter_mut().zip(outputs) {
        let mut group = outputs.iter().zip(values);
        if *output != 0 && group.any(|(other, value)| other == output && *value == dominant) {
            *result = dominant;
        }
    }
    results
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every assignment of four axes to three outputs or none, every selection: against what the manual says of two axes.
    #[test]
    fn an_axis_is_tested_with_every_axis_of_its_output() {
        for number in 0..256_u32 {
            let outputs = [0, 2, 4, 6].map(|place| number >> place & 3);
            for bits in 0..16_u8 {
                let signals = [0, 1, 2, 3].map(|place| bits >> place & 1 == 1);
                let (tests, enables) = (selected(&outputs, &signals), enabled(&outputs, &signals));
                for a in 0..4 {
                    let share = |b: usize| a == b || outputs[a] == outputs[b] && outputs[a] != 0;
                    assert_eq!(tests[a], (0..4).any(|b| share(b) && signals[b]));
                    assert_eq!(enables[a], !(0..4).any(|b| share(b) && !signals[b]));
                }
            }
        }
    }
}
