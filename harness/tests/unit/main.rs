//! The unit tests of the library, which stand in its modules. Compiled with all the rest a second time they would take as long as
//! the library, most of which has its tests in `tests/`; so the modules that have some are compiled here alone.
//! `tests/corpus/structure.rs` sees that none is missing.

#![allow(dead_code, reason = "they are only tested")]
#![allow(unused_imports, reason = "what they tell others of themselves")]

#[path = "../../src/atomic.rs"]
mod atomic;
#[path = "../../src/families/sinumerik/door.rs"]
mod door;
#[path = "../../src/browse/http.rs"]
mod http;
#[path = "../../src/matrix/mod.rs"]
mod matrix;
#[path = "../../src/export/names.rs"]
mod names;
#[path = "../../src/browse/path.rs"]
mod path;
#[path = "../../src/plant/mod.rs"]
mod plant;
#[path = "../../src/states.rs"]
mod states;
#[path = "../../src/reaction/travel.rs"]
mod travel;
