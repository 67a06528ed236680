//! Monitors of the SINUMERIK 840D / SIMODRIVE 611 digital family, Safety Integrated.
//!
//! One module is one safety function of one monitoring channel:
//!
//! | module | safety function | steps after |
//! | --- | --- | --- |
//! | [`gear`] | gear stage of a selector gearbox and its change event | - |
//! | [`agreement`] | user agreement | `gear` |
//! | [`mod@reference`] | axis referencing up to "safely referenced" | `agreement` of both channels |
//! | [`external`] | external stops by signal, reaction to errors of the safe logic | - |
//! | [`fault`] | STOP F: reaction to a discrepancy between the channels | - |
//! | [`stop`] | arbitration of all stop requests, STOP A to E with their timers | `external`, `fault`, all monitors |
//! | [`motion`] | actual position and speed of a channel | - |
//! | [`selection`] | selection of operating stop and speed stage with its delays | `motion`; `stop` of the cycle before |
//! | [`standstill`] | position window of the operating stop (SBH) | `selection` |
//! | [`speed`] | limit of the speed stage (SG), encoder limit frequency | `selection` |
//! | [`setpoint`] | limit of the speed setpoint: no safety function | `selection` of both channels |
//! | [`limit_switch`] | software limit switches (SE) | `agreement` |
//! | [`ramp`] | braking ramp (SBR) | `motion`; `stop` of the cycle before |
//! | [`threshold`] | speed threshold n < n_x | `motion` |
//! | [`cam`] | one software cam (SN) | `motion` |
//! | [`results`] | result lists for the comparison of the channels | all monitors |
//! | [`encoder`] | encoder to position: no step | - |
//! | [`interface`] | signals of an axis in the data block and at the terminals: no step | - |
//! | [`channel`] | the monitors of one channel, wired to each other | - |
//! | [`axis`] | one axis in one channel: everything it does in a cycle, and what it tells the other channel | - |
//! | [`pair`] | both channels of an axis against each other | - |
//! | [`parameters`] | machine data, checked and converted into the configurations: no step | - |
//! | [`group`] | effect of a stop on the other axes of the channel | `stop` of every axis |
//! | [`bus_failure`] | failure of the drive bus | signals and `selection`, whose place it takes in the NCK |
//! | [`test_stop`] | test of the shutdown path | before `stop`, whose test level it is |
//! | [`shutdown_test`] | test of the external shutdown (NCK) | before `stop` and `pulses` |
//! | [`pulses`] | pulse cancellation with its external fallback (NCK) | `stop`, `shutdown_test` |
//! | [`compare`] | cross comparison: list, change timer, checking timer | - |
//! | [`slip`] | synchronisation of the actual values | before `compare`, for which it decides on the positions |
//! | [`history`] | standstill position kept through power-off and its comparison | - |
//! | [`forced_check`] | how long ago the shutdown paths were tested | `test_stop` of both channels |
//! | [`relay`] | EMERGENCY STOP of the safe logic: acknowledgement, delayed outputs | inputs of the safe logic |
//! | [`spl_protection`] | safe logic of a channel: protected or being commissioned | - |
//! | [`spl_signal`] | one signal of the safe logic in the comparison of NCK and PLC | - |
//! | [`spl_comparison`] | alarm and stop of this comparison | `spl_protection`, `spl_signal` of every signal; before `external` |
//! | [`spl_link`] | watchdog over the exchange of the channels of the safe logic | before `spl_comparison` |
//! | [`spl`] | the first three of one channel, wired for all 320 signals | - |
//! | [`spl_start`] | start of the safe logic, release of the PLC-SPL | `spl_protection`, `spl_file`; before `external` |
//! | [`spl_file`] | integrity of the program of the safe logic | `spl_protection` |
//! | [`spl_access`] | who may do what with its variables and actions | - |
//! | [`spl_output_test`] | forced check of a two-channel output by one test input | - |
//! | [`spl_stop_test`] | test of the shutdown paths and external stops, one channel after the other | - |
//! | [`f_master`] | clock of the PROFIsafe communication between NCK and PLC | OB40 of the PLC; `external`: STOP D, E |
//! | [`f_module`] | data and faults of an F module | `f_master`; `external`: STOP D, E |
//! | [`f_setup`], [`net_data`] | run-up checks of the F master; which bit of an F module is which variable: no step | `f_master`, `f_module` |
//! | [`f_times`] | response times of the F master: no step | - |
//! | [`assignment`], [`db18`] | where signals and variables lie: no step | - |
//! | [`acceptance_mode`] | acceptance test mode of an axis | - |
//! | [`acceptance_alarm`] | RESET for a tested STOP B or A | `acceptance_mode`, `stop` of the cycle before |
//! | [`alarm_life`] | one alarm and its acknowledgement | what raises it |
//! | [`alarm_display`] | suppression and priorities of its display | `alarm_life` |
//! | [`brake_test`] | sequence of the brake test in the PLC (FB11) | `brake_load` of the cycle before |
//! | [`brake_torque`] | torque limits of the brake test | `brake_test` |
//! | [`brake_load`] | brake test in the NC: position window, fixed stop | `brake_torque` |
//! | [`brake_control`] | two-channel control of a holding brake | `stop` of both channels |
//! | [`sge_difference`] | alarm 27004: an input that the channels see differently | - |
//! | [`esr_trigger`] | trigger of the extended stop and retract | `stop`, `fault` of every axis |
//! | [`level`] | stops in their priority: no step | - |
//! | [`code`], [`alarm`], [`message`] | codes of STOP F and alarms: no step | - |
//!
//! Conventions common to the modules of this family:
//!
//! * One call is one monitoring cycle (T_SI), the same for all monitors (S840D-TIMING-501). Durations are [`Cycles`](crate::kernel::Cycles).
//! * Positions are increments (um or mdeg), speeds increments per cycle; limits are converted rounding down (see [`units`](crate::units)).
//!   A limit is violated only beyond it.
//! * A timer started with t expires t cycles after the cycle of its start; t = 0 expires in the cycle of the start.
//! * `power_on` first sets everything volatile to its initial value (which acknowledges every stop); requests received
//!   from the other channel are ignored in that cycle; then the cycle is evaluated with its other inputs.
//! * Selection signals are "de-select" signals: 0 (`false`) means selected, so that a lost signal selects (S840D-ARCH-504).

/// Hands the monitors of SINUMERIK 840D to a macro, after the name of the family and what else is given: the list that
/// says which there are. Each is a module with a `Monitor` that is a [`Contract`](crate::contract::Contract).
#[macro_export]
macro_rules! sinumerik_monitors {
    ($callback:ident $($more:tt)*) => { $callback! { sinumerik [$($more)*]
        stop external fault group bus_failure selection reference agreement gear test_stop shutdown_test pulses compare slip history
        forced_check relay spl_protection spl_signal spl_comparison spl_link
        spl_start spl_file spl_access spl_output_test spl_stop_test f_master f_module acceptance_mode acceptance_alarm alarm_life alarm_display
        brake_test brake_torque brake_load brake_control sge_difference esr_trigger
        motion standstill speed setpoint limit_switch ramp threshold cam results channel
    } };
}

pub mod acceptance_alarm;
pub mod acceptance_mode;
pub mod agreement;
pub mod alarm;
pub mod alarm_display;
pub mod alarm_life;
pub mod assignment;
pub mod axis;
pub mod brake_control;
pub mod brake_load;
pub mod brake_test;
pub mod brake_torque;
pub mod bus_failure;
pub mod cam;
pub mod channel;
pub mod code;
pub mod compare;
pub mod db18;
pub mod encoder;
pub mod esr_trigger;
pub mod external;
pub mod f_master;
pub mod f_module;
pub mod f_setup;
pub mod f_times;
pub mod fault;
pub mod forced_check;
pub mod gear;
pub mod group;
pub mod history;
pub mod interface;
pub mod level;
pub mod limit_switch;
pub mod message;
pub mod motion;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod net_data;
pub mod pair;
pub mod parameters;
pub mod path_test;
pub mod pulses;
pub mod ramp;
pub mod reference;
pub mod relay;
pub mod results;
pub mod selection;
pub mod setpoint;
pub mod sge_difference;
pub mod shutdown_group;
pub mod shutdown_test;
pub mod slip;
pub mod speed;
pub mod spl;
pub mod spl_access;
pub mod spl_comparison;
pub mod spl_file;
pub mod spl_link;
pub mod spl_output_test;
pub mod spl_protection;
pub mod spl_signal;
pub mod spl_start;
pub mod spl_stop_test;
pub mod standstill;
pub mod stop;
pub mod test_stop;
pub mod threshold;
