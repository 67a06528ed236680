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
//! | [`startup`] | protection against unexpected start-up | `group` of the cycle before |
//! | [`judge`] | stops that requests, machine operating mode and permissive demand | `both_channels`, `startup` |
//! | [`axis_release`] | feed enable of one axis in a released group, with an SS2 of its own | `group` of the cycle before |
//! | [`stop`] | stop reaction of one axis group: SS2, SS1D, SS1, SS1F, SS0 with their timers | `judge`, all monitors |
//! | [`group`] | monitoring state of one axis group | `stop` |
//! | [`switch_on`] | control voltage on: edge, chain of contacts, -STO.A.G | `stop` of every group |
//! | [`output_enable`] | `NN_GenOutputEnable` | `stop` of every group |
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

pub mod axis_release;
pub mod both_channels;
pub mod button;
pub mod channel;
pub mod gate;
pub mod group;
pub mod judge;
#[cfg(feature = "mutants")]
pub mod mutant;
pub mod output_enable;
pub mod som;
pub mod startup;
pub mod stop;
pub mod switch_on;
pub mod types;
