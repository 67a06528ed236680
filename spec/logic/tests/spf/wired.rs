//! How a program is wired to a machine: inputs, further inputs, outputs, cycles in which it does not run.

use std::sync::Arc;

use stillpoint_logic::Input;
use stillpoint_logic::spf::{Interface, Mode, Output, Variable, parse};

use super::rig::{Spl, compiled, interface, output, sequences, spec, variable};

/// With the range that has to be protected: S840D-LANG-710.
#[test]
fn variables_are_told_with_their_names() {
    let text = "DEFINE DOOR AS $A_INSE[3]\nDEFINE DOOR_2 AS $A_INSE[03]\nDEFINE RUN AS $A_OUTSI[7]\n\
                DEFINE SPARE AS $A_MARKERSI[2]\n\
                IDS=1 EVERY DOOR == 1 DO RUN = $A_PLCSIIN[1]\nIDS=2 DO $A_MARKERSI[64] = RUN\nM17\n";
    let program = parse("x.spf", &Arc::from(text), Mode::Strict).expect("right");
    let told: Vec<String> = (program.variables().iter())
        .map(|v| {
            format!(
                "{} {:?} {} {} {}",
                v.variable, v.names, v.reads, v.writes, v.line
            )
        })
        .collect();
    assert_eq!(
        told,
        [
            "INSE[3] [\"DOOR\", \"DOOR_2\"] true false 5",
            "MARKERSI[2] [\"SPARE\"] false false 4",
            "MARKERSI[64] [] false true 6",
            "OUTSI[7] [\"RUN\"] true true 5",
            "PLCSIIN[1] [] true false 5",
        ]
    );
    assert_eq!(program.protected(), Some((1, 2)));
}

#[test]
fn names_of_variables_are_read_as_they_are_shown() {
    for text in [
        "INSE[3]",
        "VA_DPE[X1]",
        "STOPESI",
        "DBB[4]",
        "AC_MARKER[20]",
        "TIMERSI[16]",
    ] {
        let read: Variable = text.parse().expect(text);
        assert_eq!(read.to_string(), text);
        assert_eq!(read.written().parse(), Ok(read));
    }
    let wrong = |text: &str| text.parse::<Variable>().expect_err(text);
    assert_eq!(
        wrong("INSE[65]"),
        "there is no `$A_INSE[65]`; its index is a number, 1..64"
    );
    assert_eq!(
        wrong("OUTS[1]"),
        "there is no system variable `$OUTS`; did you mean `$A_OUTSE`?"
    );
    assert_eq!(
        wrong("INSE[1"),
        "`INSE[1`: the bracket is not closed; write INSE[3]"
    );
}

/// What the program reads, does not write, and the interface does not name, is a further input, with the values that it can have.
#[test]
fn what_nothing_gives_is_free() {
    let blocks = "IDS=1 DO $A_OUTSE[1] = $A_INSE[1] AND ($A_INSE[3] OR $A_INSI[12] OR $A_PLCSIIN[1] OR $VA_DPE[X1])\n\
                  IDS=2 WHENEVER ($A_DBB[2] == 7) OR ($A_XFAULTSI <> 0) DO $A_OUTSE[2] = 1\n\
                  IDS=3 WHENEVER ($A_STOPESI > 4) AND $A_MARKERSI[9] DO $A_OUTSE[2] = 0\n\
                  IDS=4 WHENEVER $AC_MARKER[3] == -2 DO $A_OUTSE[2] = 0\n\
                  IDS=5 DO $A_OUTSI[1] = $A_INSI[60]\nM17";
    let compiled = compiled(blocks, &interface()).expect("right");
    let input = |name: &str, ty: &str, variable: &str| Input {
        name: name.to_owned(),
        ty: ty.to_owned(),
        variable: variable.to_owned(),
    };
    // Marker 9 is written by nobody, and is 0; nothing needs OUTSI[1], and so INSI[60]; nor, with marker 9, STOPESI.
    let mut told = compiled.inputs;
    told.sort_by(|a, b| a.name.cmp(&b.name));
    assert_eq!(
        told,
        [
            input("ac_marker_3", "INT(-3..5)", "AC_MARKER[3]"),
            input("dbb_2", "INT(6..8)", "DBB[2]"),
            input("inse_3", "BOOL", "INSE[3]"),
            input("insi_12", "BOOL", "INSI[12]"),
            input("plcsiin_1", "BOOL", "PLCSIIN[1]"),
            input("va_dpe_x1", "BOOL", "VA_DPE[X1]"),
            input("xfaultsi", "INT(0..1)", "XFAULTSI"),
        ]
    );
}

#[test]
fn times_are_given_as_they_are_rounded() {
    let blocks = "IDS=1 EVERY $A_INSE[1] DO $A_TIMERSI[1] = 0\n\
                  IDS=2 DO $A_OUTSE[1] = ($A_TIMERSI[1] > 1.0) $A_OUTSE[2] = ($A_TIMERSI[1] >= 0.4)\nM17";
    let compiled = compiled(blocks, &interface()).expect("right");
    let times = [("spf_400ms", 400_000), ("spf_over_1s", 1_000_001)];
    assert_eq!(
        compiled.durations,
        times.map(|(name, us)| (name.to_owned(), us))
    );
}

#[test]
fn outputs_are_constant_inverted_or_numbers() {
    let mut wired = interface();
    wired.outputs = vec![
        ("n".to_owned(), output("AC_MARKER[1]")),
        ("q".to_owned(), Output::Constant(true)),
        (
            "p".to_owned(),
            Output::Variable {
                variable: variable("OUTSE[1]"),
                inverted: true,
            },
        ),
    ];
    let blocks = "IDS=1 DO $A_OUTSE[1] = $A_INSE[1]\nIDS=2 WHENEVER $A_INSE[2] DO $AC_MARKER[1] = $A_DBB[1]\n\
                  IDS=3 WHENEVER $AC_MARKER[1] == 7 DO $AC_MARKER[1] = 2";
    let mut spl = Spl::new(blocks, &wired, 1_000);
    assert_eq!(spl.step(&[]), [1, 1, 0]);
    assert_eq!(spl.step(&[("a", 1), ("b", 1), ("byte", 5)]), [0, 1, 5]);
    assert_eq!(spl.step(&[("byte", 6)]), [1, 1, 5]);
    assert_eq!(spl.step(&[("b", 1), ("byte", 7)]), [1, 1, 2]);
    // What the program never writes is 0.
    let mut silent = Spl::new("IDS=1 DO $A_OUTSI[1] = 1", &wired, 1_000);
    assert_eq!(silent.step(&[]), [1, 1, 0]);
}

/// In cycles without a scan everything stays, and timers do not count.
#[test]
fn without_a_scan_everything_stays() {
    let blocks = "IDS=1 EVERY $A_INSE[1] DO $A_TIMERSI[1] = 0\n\
                  IDS=2 DO $A_OUTSE[1] = ($A_TIMERSI[1] > 0.01)\n\
                  IDS=3 DO $A_OUTSE[2] = $A_INSE[1] XOR $A_OUTSE[2]";
    let mut wired = interface();
    let mut always = Spl::new(blocks, &wired, 10_000);
    wired.scan = Some("ipo".to_owned());
    let mut scanned = Spl::new(blocks, &wired, 10_000);
    let mut kept = 0;
    for inputs in sequences(4, 7) {
        always.restart();
        scanned.restart();
        let mut last = [0; 3];
        for input in inputs {
            let (a, runs) = ((input % 2) as i32, input / 2 == 1);
            let is = scanned.step(&[("a", a), ("ipo", i32::from(runs))]);
            if runs {
                last = always.step(&[("a", a)]);
            }
            kept += u32::from(!runs && last != [0; 3]);
            assert_eq!(is, last);
        }
    }
    assert!(kept > 1_000, "{kept}");
}

/// A program is shown as it was understood, and this is a program with the same meaning.
#[test]
fn what_is_shown_is_the_same_program() {
    let text = "%_N_SAFE_SPF\nDEFINE A AS $A_INSE[1]\nDEFINE LIMIT AS 3\nDEF INT S\n\
                SIRELIN(3, S, \"A\", \"$A_MARKERSI[1]\", \"A\")\nSIRELOUT(3, S, \"$A_OUTSE[1]\")\nSIRELTIME(3, S, 0.25)\n\
                IDS=9 WHENEVER NOT (A OR $A_INSE[2]) XOR A DO $A_OUTSE[2] = (A == 0) $A_TIMERSI[1] = -1.5\n\
                ID=8 FROM $A_DBB[1] >= LIMIT DO $AC_MARKER[1] = SIRELAY(3)\nM30\n";
    let read = |text: &str| {
        parse("x.spf", &Arc::from(text), Mode::Strict).unwrap_or_else(|e| panic!("{e}"))
    };
    let shown = read(text).to_string();
    assert_eq!(read(&shown).to_string(), shown);
    assert_eq!(
        shown,
        "DEF INT STATUS\nSIRELIN(3, STATUS, \"$A_INSE[1]\", \"$A_MARKERSI[1]\", \"$A_INSE[1]\")\n\
         SIRELOUT(3, STATUS, \"$A_OUTSE[1]\")\nSIRELTIME(3, STATUS, 0.25)\n\
         ID=8 FROM $A_DBB[1] >= 3 DO $AC_MARKER[1] = SIRELAY(3)\n\
         IDS=9 WHENEVER (NOT ($A_INSE[1] OR $A_INSE[2])) XOR $A_INSE[1] DO $A_OUTSE[2] = ($A_INSE[1] == 0) $A_TIMERSI[1] = -1.5\nM17\n"
    );
}

#[test]
fn an_interface_that_does_not_fit_is_refused() {
    let program = "IDS=1 DO $A_OUTSE[1] = $A_INSE[1] $A_MARKERSI[1] = $A_DBB[1] == 3\nM17";
    type Change = fn(&mut Interface);
    let wrong = |change: Change| {
        let mut wired = interface();
        change(&mut wired);
        match compiled(program, &wired) {
            Ok(_) => panic!("accepted"),
            Err(errors) => errors.to_string(),
        }
    };
    let cases: [(&str, Change); 14] = [
        ("no such input", |i| {
            i.inputs.push((variable("INSE[9]"), "aa".to_owned()))
        }),
        ("another type", |i| {
            i.inputs.push((variable("INSE[9]"), "byte".to_owned()))
        }),
        ("a number from BOOL", |i| {
            i.inputs.push((variable("DBB[9]"), "a".to_owned()))
        }),
        ("an enum", |i| {
            i.inputs.push((variable("INSE[9]"), "colour".to_owned()))
        }),
        ("wired twice", |i| {
            i.inputs.push((variable("INSE[1]"), "b".to_owned()))
        }),
        ("written", |i| {
            i.inputs.push((variable("OUTSE[1]"), "b".to_owned()))
        }),
        ("a timer", |i| {
            i.inputs.push((variable("TIMERSI[1]"), "b".to_owned()))
        }),
        ("no such scan", |i| i.scan = Some("ipoo".to_owned())),
        ("a scan of another type", |i| {
            i.scan = Some("byte".to_owned())
        }),
        ("an output is missing", |i| i.outputs.truncate(1)),
        ("no such output", |i| {
            i.outputs.push(("r".to_owned(), Output::Constant(true)))
        }),
        ("an output twice", |i| {
            i.outputs.push(("p".to_owned(), Output::Constant(true)))
        }),
        ("an input as output", |i| i.outputs[0].1 = output("INSE[1]")),
        ("an output of another type", |i| {
            i.outputs[2].1 = Output::Constant(false)
        }),
    ];
    let told: Vec<String> = cases
        .iter()
        .map(|(title, change)| format!("--- {title}\n{}", wrong(*change)))
        .collect();
    insta::assert_snapshot!(told.join("\n"));
}

/// The examples of the manual run in the place of a machine, and take what they have not from the machine as free inputs.
#[test]
fn the_whole_programs_of_the_manual_have_tables() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/corpus/sinumerik-840d/safe-spf");
    for (name, outputs, free) in [
        ("main", ["OUTSI[2]", "OUTSE[1]"], "DBB[4] INSE[11] INSE[4]"),
        ("profisafe", ["OUTSI[3]", "OUTSE[9]"], "INSE[4] PLCSIOUT[1]"),
        ("light-barrier", ["OUTSI[1]", "OUTSI[2]"], ""),
    ] {
        let text = std::fs::read_to_string(folder.join(format!("{name}.spf"))).expect(name);
        let source: Arc<str> = Arc::from(text.as_str());
        let program = parse(name, &source, Mode::Listing).unwrap_or_else(|e| panic!("{e}"));
        let mut wired = interface();
        wired.outputs[0].1 = output(outputs[0]);
        wired.outputs[1].1 = output(outputs[1]);
        wired.outputs[2].1 = output("AC_MARKER[9]");
        let compiled = program.compile(&wired).unwrap_or_else(|e| panic!("{e}"));
        let mut told: Vec<&str> = compiled
            .inputs
            .iter()
            .map(|i| i.variable.as_str())
            .collect();
        told.sort_unstable();
        assert_eq!(told.join(" "), free, "{name}");
        let mut own = spec();
        let machine = toml::Spanned::new(0..0, "spl".to_owned());
        own.replace(name, &source, &machine, &compiled.machine)
            .unwrap_or_else(|e| panic!("{e}"));
        own.open_machine("spl").unwrap_or_else(|e| panic!("{e}"));
    }
}

/// The example machine, what its half in the NCK only copies: S840D-EXAMPLE-712, S840D-TESTSTOP-704.
#[test]
fn the_copies_of_the_example_machine() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/machines/emergency-stop-840d.spf"
    );
    let text = std::fs::read_to_string(path).expect("readable");
    let blocks = text.trim_end().strip_suffix("N1070 M17").expect("its end");
    for (from, to) in [
        ("INSI[1]", "OUTSE[3]"),
        ("INSI[2]", "OUTSE[4]"),
        ("INSE[7]", "OUTSI[9]"),
        ("INSE[8]", "OUTSI[10]"),
        ("INSE[9]", "OUTSI[7]"),
        ("INSE[10]", "OUTSI[8]"),
    ] {
        let wired = Interface {
            inputs: vec![(variable(from), "a".to_owned())],
            outputs: vec![
                ("p".to_owned(), output(to)),
                ("q".to_owned(), Output::Constant(false)),
                ("n".to_owned(), output("AC_MARKER[1]")),
            ],
            ..interface()
        };
        let mut spl = Spl::new(blocks, &wired, 12_000);
        for value in [1, 0, 1] {
            assert_eq!(
                spl.step(&[("a", value)])[0],
                i64::from(value),
                "{from} to {to}"
            );
        }
    }
}
