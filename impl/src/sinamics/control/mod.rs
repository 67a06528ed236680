//! The control part: how functions are selected, which stop wins, what acknowledges it, what supervises the paths.
//!
//! | module | function |
//! | --- | --- |
//! | [`input_filter`] | filter of one input against test pulses (p9651, p10017) |
//! | [`terminal_pair`], [`chatter`] | terminals of the Basic Functions: discrepancy, too frequent switching |
//! | [`basic_selection`] | STO and SS1 over terminals and PROFIsafe in parallel |
//! | [`basic_stop`] | STOP F and STOP A of the Basic Functions |
//! | [`fail_safe_input`] | F-DI of TM54F and CU310-2 |
//! | [`fail_safe_output`], [`safe_state`] | F-DO, and the signal Safe State |
//! | [`stop_arbiter`] | STOP A to F of the Extended Functions, with the functions' levels |
//! | [`cross_check`] | comparison of the channels' results: STOP F |
//! | [`acknowledgement_edge`], [`acknowledgement`] | what acknowledges, and what of it is cleared |
//! | [`restart`] | from STO back to torque |
//! | [`communication`] | PROFIsafe and TM54F supervision, ESR on failure |
//! | [`io_test`] | test stop of F-DI and F-DO |
//! | [`message_buffer`] | safety messages |
//! | [`acceptance_mode`], [`commissioning`] | acceptance test mode, commissioning mode |
//! | [`replacement`] | replaced components |
//! | [`level`], [`control_path`] | stops and functions; p9601 and what belongs to it: no step |

pub mod acceptance_mode;
pub mod acknowledgement;
pub mod acknowledgement_edge;
pub mod basic_selection;
pub mod basic_stop;
pub mod chatter;
pub mod commissioning;
pub mod communication;
pub mod control_path;
pub mod cross_check;
pub mod fail_safe_input;
pub mod fail_safe_output;
pub mod input_filter;
pub mod io_test;
pub mod level;
pub mod message_buffer;
pub mod replacement;
pub mod restart;
pub mod safe_state;
pub mod stop_arbiter;
pub mod terminal_pair;
