use std::path::{Path, PathBuf};

use stillpoint_proofs::results::sources::{code, modules, named, stubs};

#[test]
fn a_monitor_needs_the_modules_it_names() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../impl/src/sinumerik");
    let modules = modules(&root);
    assert!(!modules.contains_key("mutant"));
    assert_eq!(
        modules["selection"].len(),
        2,
        "the module and its file of limits"
    );
    let needed = |name: &str| named(&modules[name].join("\n"), &modules);
    assert!(needed("channel").contains(&"ramp".to_owned()));
    assert!(!needed("ramp").contains(&"channel".to_owned()));
}

#[test]
fn a_stub_is_a_source() {
    let attributes = "kani(stub(a::b, crate :: properties::sinumerik::units::by_definition::quotient), stub(c, \
        crate::total::srm::endzone), stub(d, crate::kani_source::folded_in_range))";
    let files = ["src/properties/sinumerik/units.rs", "src/total.rs"];
    assert_eq!(stubs(attributes), files.map(PathBuf::from).into());
}

#[test]
fn comments_do_not_count() {
    let folder = std::env::temp_dir().join(format!("fingerprint-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("a.rs");
    std::fs::write(&file, "// one\nfn a() {}\n\n").expect("a file");
    let first = code(&file);
    std::fs::write(&file, "fn a() {}\n/// two\n").expect("a file");
    assert_eq!(first, code(&file));
    std::fs::remove_dir_all(&folder).expect("removed");
}
