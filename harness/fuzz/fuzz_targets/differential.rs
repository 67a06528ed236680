//! Every monitor against its table on runs that the fuzzer describes; see `stillpoint::diff::bytes`. The first byte chooses
//! the machine and its parameters, those of the machine file named here.
#![no_main]

use std::path::Path;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use stillpoint::diff::product::Product;
use stillpoint::diff::{Pairing, bytes, pairings, peer};
use stillpoint::subject::{self, Readings};

static PAIRINGS: LazyLock<Vec<Pairing>> = LazyLock::new(|| {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec/machines/milling-840d.toml");
    let subject = subject::load(&file, &Readings::new()).unwrap_or_else(|e| panic!("{e}"));
    pairings(&subject).unwrap_or_else(|e| panic!("{e}"))
});

fuzz_target!(|data: &[u8]| {
    let Some((machine, run)) = data.split_first() else {
        return;
    };
    let pairing = &PAIRINGS[usize::from(*machine) % PAIRINGS.len()];
    let monitor = peer::peer(&pairing.machine, &pairing.bound, None)
        .unwrap_or_else(|e| panic!("{e}"))
        .unwrap_or_else(|| panic!("machine `{}` has no monitor", pairing.machine));
    let product = Product::new(&pairing.bound, monitor.as_ref()).unwrap_or_else(|e| panic!("{e}"));
    if let Some(found) = bytes::run(&product, pairing.bound.inputs.len(), run) {
        panic!("{}\n{}", pairing.machine, product.diagram(&found.start, &found.cycles).text());
    }
});
