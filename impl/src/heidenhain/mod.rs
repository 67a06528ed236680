//! Monitors of HEIDENHAIN Functional Safety (iTNC 530 HSCI, NC software 606 42x).
//!
//! One module is one safety function of one channel: channel A runs on the main computer (MC), channel B on the controller
//! computer (CC). In each channel a safety kernel (SKERN) executes and monitors; a safe PLC program (SPLC) of the machine
//! builder tells it by the fields `PP_...` what is wanted, and reads the fields `NN_...`.
//!
//! | module | safety function | steps after |
//! | --- | --- | --- |
//! | [`som`] | safe operating mode from the keylock inputs (safe PLC) | - |
//! | [`button`] | validity of a permissive button or key (safe PLC) | - |
//! | [`gate`] | what the kernel takes over from its safe PLC for one axis group | - |
//! | [`both_channels`] | the stricter of what the two channels were asked for | `gate` of both channels |
//! | [`both_fields`] | the general fields of both channels: compared, the stricter in force | `general_fields` of both channels |
//! | [`both_status`] | execution of both programs, their run-time systems, outputs that read back: compared | - |
//! | [`startup`] | protection against unexpected start-up | `group` of the cycle before |
//! | [`judge`] | stops that requests, machine operating mode and permissive demand | `both_channels`, `startup` |
//! | [`axis_release`] | feed enable of one axis in a released group, with an SS2 of its own | `group` of the cycle before |
//! | [`stop`] | stop reaction of one axis group: SS2, SS1D, SS1, SS1F, SS0 with their timers | `judge`, all monitors |
//! | [`report`] | what one channel tells the other of its stop and its causes | `stop` |
//! | [`neighbour`] | what the stop of one group makes of the others | `stop` of the cycle before |
//! | [`global_sto`] | -STO.A.G while one axis is in SS0 and the others brake | `stop` of every group |
//! | [`group`] | monitoring state of one axis group | `stop` |
//! | [`switch_on`] | control voltage on: edge, chain of contacts, -STO.A.G | `stop` of every group |
//! | [`output_enable`] | `NN_GenOutputEnable` | `stop` of every group |
//! | [`speed`] | limited speed (SLS) of an axis or spindle | `group` of the cycle before |
//! | [`operating_stop`] | operating stop (SOS): speed and path of a standing axis | `group` of the cycle before |
//! | [`stop_path`] | path of an axis during SS2 | `stop` of the cycle before |
//! | [`position_limit`] | limited position (SLP) with its return lock | `reference` |
//! | [`revolutions`] | two revolutions of restricted spindle operation | `group` of the cycle before |
//! | [`comparison`] | nominal with actual value: position or speed | `group` of the cycle before |
//! | [`deceleration`] | dv/dt on the emergency ramp | `stop` of the cycle before |
//! | [`axis_count`] | how many axes move at a time with the door open | `group` of the cycle before |
//! | [`reference`] | referencing of an axis up to "axis checked" | - |
//! | [`agreement`] | one item compared between the channels, with its window | both channels |
//! | [`cc_link`] | telegrams between two controller computers, of one drive | - |
//! | [`brakes`] | brake outputs of a safe PLC | `stop` |
//! | [`tool_holder`] | opening of the tool holder by a safe PLC | `group` of the cycle before |
//! | [`acceptance`] | acceptance of changed safe machine parameters | - |
//! | [`key_filter`] | keys of one operating unit at a time, group signal of the keys (safe PLC) | `button` |
//! | [`axes_logic`], [`spindle_logic`], [`magazine_logic`] | requests for the three groups of a milling machine (safe PLC) | `key_filter`, `som` |
//! | [`jog_increment`] | jog increments of an axis (safe PLC) | `key_filter` |
//! | [`control_voltage`] | control voltage and drive permissions asked for, reset button (safe PLC) | `switch_on` of the cycle before |
//! | [`safe_input`], [`working_space`] | marker of a safe input; whether a space is protected (safe PLC) | - |
//! | [`safe_output`], [`allowed_functions`] | outputs and functions that a person must not meet (safe PLC) | `output_enable` |
//! | [`general_fields`] | what the kernel takes over of the general fields | - |
//! | [`program_check`] | checksum and interface of the program of a safe PLC | - |
//! | [`group_motion`], [`availability`], [`f_limited`] | `NN_AxGrpInMotion`; table of the safety functions; soft key F LIMITED | - |
//! | [`safe_plc`] | the requests of the three groups wired to a program | - |
//! | [`self_test`] | order of the self-test, its interval | - |
//! | [`cut_out`] | part of the self-test: brake control, contact chain, each channel alone, safe outputs | `self_test` |
//! | [`holding_brake`] | part of the self-test: holding brake of an axis | `self_test` |
//! | [`status_bits`] | reactions to the safe status bits of a telegram | - |
//! | [`sampling`] | forced dynamic sampling of a pair of inputs | - |
//! | [`self_checks`] | reactions to faults that the kernel finds in itself | - |
//! | [`start_checks`] | configuration while the control boots | - |
//! | [`parameters`] | safe machine parameters, checked and converted: no step | - |
//! | [`channel`] | the monitors of one axis group in one channel, wired to each other | - |
//! | [`types`] | stops, monitoring states, modes in their priority: no step | - |
//!
//! Conventions common to the modules of this family:
//!
//! * One call is one HSCI cycle of 3 ms, the same for all monitors. Durations are [`Cycles`](crate::kernel::Cycles).
//! * Monitors judge with the monitoring state valid at the start of the cycle; of all causes of a cycle the highest stop
//!   wins; a stop beats a release, a stricter request beats a laxer one (HFS-STOP-009).
//! * A timer started with t expires t cycles after the cycle of its start; it runs for one cycle at least, also with t = 0.
//! * `main_switch` and `power_on` (main switch off and on) set everything volatile to its initial value; their cycle does
//!   nothing else, what its other inputs ask for counts from the next one on.
//! * A signal that is missing must be the one that stops: an output that permits is `true` only when it was worked out.

/// Hands the monitors of HEIDENHAIN Functional Safety to a macro, after the name of the family and what else is given: the list that
/// says which there are. Each is a module with a `Monitor` that is a [`Contract`](crate::contract::Contract).
#[macro_export]
macro_rules! heidenhain_monitors {
    ($callback:ident $($more:tt)*) => { $callback! { heidenhain [$($more)*]
        gate both_channels both_fields both_status stop report neighbour global_sto judge group startup axis_release som
        button switch_on output_enable channel
        speed operating_stop stop_path position_limit revolutions comparison deceleration axis_count
        reference agreement brakes tool_holder acceptance cc_link self_test cut_out holding_brake sampling status_bits
        self_checks start_checks
        key_filter axes_logic spindle_logic magazine_logic
        safe_input working_space control_voltage jog_increment general_fields program_check availability
        allowed_functions f_limited group_motion safe_output
    } };
}

pub mod acceptance;
pub mod agreement;
pub mod axis_count;
pub mod axis_release;
pub mod both_channels;
pub mod both_fields;
pub mod both_status;
pub mod brakes;
pub mod button;
pub mod cc_link;
pub mod channel;
pub mod comparison;
pub mod cut_out;
pub mod deceleration;
pub mod gate;
pub mod global_sto;
pub mod group;
pub mod holding_brake;
pub mod judge;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod neighbour;
pub mod operating_stop;
pub mod output_enable;
pub mod parameters;
pub mod position_limit;
pub mod reference;
pub mod report;
pub mod revolutions;
pub mod safe_plc;
pub mod sampling;
pub mod self_checks;
pub mod self_test;
pub mod som;
pub mod speed;
pub mod start_checks;
pub mod startup;
pub mod status_bits;
pub mod stop;
pub mod stop_path;
pub mod switch_on;
pub mod tool_holder;
pub mod types;

// The blocks of the safe PLC under the names of monitors, like all others.
pub use safe_plc::{
    allowed_functions, availability, axes_logic, control_voltage, f_limited, general_fields,
    group_motion, jog_increment, key_filter, magazine_logic, program_check, safe_input,
    safe_output, spindle_logic, working_space,
};
