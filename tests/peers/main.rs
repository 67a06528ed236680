//! Everything that is computed twice: tables against monitors, interpreter against generated code, reduced explorations against
//! whole ones, certificates, and exported systems in other tools.

mod btor2;
mod certificates;
mod cited;
mod differential;
mod engines;
mod evaluators;
mod exports;
mod nusmv;
mod pair;
mod products;
mod proof;
mod reductions;
mod rumur;
mod spin;
mod stages;
mod theorems;
mod two_runs;
mod yardstick;
