//! How a program is wired to a machine: inputs, further inputs, copies of terminals, outputs, cycles in which it does not run.

use std::sync::Arc;

use stillpoint_logic::Input;
use stillpoint_logic::stl::{Bit, Interface, Output, parse};

use super::rig::{Plc, bit, compiled, interface, output};

/// With the layout of DB18: S840D-EXAMPLE-722.
#[test]
fn names_of_bits_are_read_as_they_are_shown() {
    for (text, shown) in [
        ("E 76.0", "E76.0"),
        ("I76.0", "E76.0"),
        ("Q 48.2", "A48.2"),
        ("m211.7", "M211.7"),
        ("DB31.DBX 22.1", "DB31.DBX22.1"),
        ("DB18.DBX 62.2", "OUTSIP[3]"),
        ("OUTSIP[3]", "OUTSIP[3]"),
        ("$A_OUTSIP[3]", "OUTSIP[3]"),
        // The image that the PLC has of a variable of the NCK.
        ("OUTSI[3]", "OUTSIP[3]"),
        ("DB18.DBX38.0", "INSEP[1]"),
        ("DB18.DBX69.7", "OUTSIP[64]"),
        ("DB18.DBX70.4", "MARKERSIP[5]"),
        ("DB18.DBX36.0", "DB18.DBX36.0"),
        ("DB18.DBX131.7", "PLCSIOUT[32]"),
        ("DB18.DBX132.0", "PLCSIIN[1]"),
    ] {
        let read: Bit = text.parse().expect(text);
        assert_eq!(read.to_string(), shown);
        assert_eq!(shown.parse(), Ok(read));
    }
    for wrong in [
        "",
        "E",
        "E76",
        "E76.8",
        "Z1.0",
        "DB31.22.1",
        "OUTSI[65]",
        "OUTSI[0]",
        "OUTSI[3",
        "PLCSIIN[33]",
        "MB194",
        "E99999.0",
    ] {
        let told = wrong.parse::<Bit>().expect_err(wrong);
        assert!(
            told.contains("write") || told.contains("variables are"),
            "{told}"
        );
    }
}

#[test]
fn bits_are_told_with_their_names() {
    let text = "SYMBOLS\n\"SPL\".NOT_HALT : MARKERSIP[2]\n\"Test\" : M 211.0\nEND_SYMBOLS\nU \"SPL\".NOT_HALT\nUN \"Test\"\nFP M 1.0\nS A 4.0";
    let program = parse("x.stl", &Arc::from(text)).expect("right");
    let told: Vec<String> = (program.bits().iter())
        .map(|u| format!("{} {:?} {} {} {}", u.bit, u.name, u.reads, u.writes, u.line))
        .collect();
    assert_eq!(
        told,
        [
            "A4.0 None false true 8",
            "M1.0 None true true 7",
            "M211.0 Some(\"\\\"Test\\\"\") true false 6",
            "MARKERSIP[2] Some(\"\\\"SPL\\\".NOT_HALT\") true false 5",
        ]
    );
}

/// What the program reads, does not write, and the interface does not name, is a further input.
#[test]
fn what_nothing_gives_is_free() {
    let text = "SYMBOLS\n\"Test\" : M 211.0\nEND_SYMBOLS\nU E 0.0\nUN \"Test\"\nU DB31.DBX 108.2\nU INSIP[3]\n= A 4.0\nL MB 12\nL 7\n==I\n= A 4.1\nU M 5.0\n= M 5.1";
    let mut told = compiled(text, &interface()).expect("right").inputs;
    told.sort_by(|a, b| a.name.cmp(&b.name));
    let input = |name: &str, ty: &str, variable: &str| Input {
        name: name.to_owned(),
        ty: ty.to_owned(),
        variable: variable.to_owned(),
    };
    // Nothing needs M 5.1, and so M 5.0.
    assert_eq!(
        told,
        [
            input("db31_dbx108_2", "BOOL", "DB31.DBX108.2"),
            input("insip_3", "BOOL", "INSIP[3]"),
            input("m_211_0", "BOOL", "\"Test\""),
            input("mb_12", "INT(0..255)", "MB12"),
        ]
    );
}

/// A variable that the program copies from a terminal is wired at the terminal.
#[test]
fn a_copy_of_a_terminal_is_wired_there() {
    let text =
        "SET\n= M 1.0\nU E 76.0\n= M 1.1\n= INSEP[1]\nU INSEP[1]\n= A 4.0\nU E 76.0\n= A 4.1";
    let wired = Interface {
        inputs: vec![(bit("INSE[1]"), "a".to_owned())],
        ..interface()
    };
    let mut plc = Plc::new(text, &wired, 10_000);
    assert_eq!(plc.step(&[("a", 1)]), [true, true]);
    assert_eq!(plc.step(&[("a", 0)]), [false, false]);
    for wrong in [
        "U E 76.0\nU E 76.1\n= INSEP[1]\nU INSEP[1]\n= A 4.0",
        "UN E 76.0\n= INSEP[1]\nU INSEP[1]\n= A 4.0",
        "U E 76.0\n= INSEP[1]\nU E 76.1\n= INSEP[1]\nU INSEP[1]\n= A 4.0",
        "U M 76.0\n= INSEP[1]\nU INSEP[1]\n= A 4.0",
    ] {
        let Err(told) = compiled(wrong, &wired) else {
            panic!("accepted: {wrong}")
        };
        assert!(
            told.to_string()
                .contains("another value than that of one input"),
            "{told}"
        );
    }
}

#[test]
fn outputs_can_be_constant_or_inverted() {
    let changed = Interface {
        outputs: vec![
            ("p".to_owned(), Output::Constant(true)),
            (
                "q".to_owned(),
                Output::Bit {
                    bit: bit("A4.0"),
                    inverted: true,
                },
            ),
        ],
        ..interface()
    };
    let mut plc = Plc::new("U E 0.0\n= A 4.0", &changed, 10_000);
    assert_eq!(plc.step(&[("a", 1)]), [true, false]);
    assert_eq!(plc.step(&[("a", 0)]), [true, true]);
    // A bit that nothing writes is 0.
    let never = Interface {
        outputs: vec![
            ("p".to_owned(), output("OUTSI[9]")),
            ("q".to_owned(), output("A4.0")),
        ],
        ..interface()
    };
    let mut plc = Plc::new("U E 0.0\n= A 4.0", &never, 10_000);
    assert_eq!(plc.step(&[("a", 1)]), [false, true]);
}

/// Between its runs everything stays, and timers go on.
#[test]
fn the_plc_runs_in_some_cycles_only() {
    let scanned = Interface {
        scan: Some("ob1".to_owned()),
        ..interface()
    };
    let text = "U E 0.0\nL S5T#30MS\nSE T 1\nU T 1\n= A 4.0\nU E 0.1\nFP M 1.0\n= A 4.1";
    let mut plc = Plc::new(text, &scanned, 10_000);
    let mut step = |run, a, b| plc.step(&[("ob1", run), ("a", a), ("b", b)]);
    assert_eq!(step(1, 1, 1), [false, true]);
    assert_eq!(step(0, 0, 0), [false, true], "nothing is seen");
    assert_eq!(step(0, 0, 0), [false, true]);
    assert_eq!(step(1, 1, 1), [true, false], "30 ms later");
    assert_eq!(step(0, 0, 0), [true, false]);
    assert_eq!(step(1, 0, 0), [false, false]);
}

#[test]
fn an_interface_that_does_not_fit_is_refused() {
    let told =
        |interface: &Interface| match compiled("U E 0.0\n= A 4.0\nU M 9.0\n= A 4.1", interface) {
            Ok(_) => panic!("accepted"),
            Err(errors) => {
                let mut said = String::new();
                for one in &errors.0 {
                    said += &format!("{one}; {}\n", one.help);
                }
                said
            }
        };
    let with = |inputs: &[(&str, &str)], outputs: &[(&str, &str)]| Interface {
        inputs: inputs
            .iter()
            .map(|(of, port)| (bit(of), (*port).to_owned()))
            .collect(),
        outputs: outputs
            .iter()
            .map(|(port, of)| ((*port).to_owned(), output(of)))
            .collect(),
        ..interface()
    };
    let right = [("p", "A4.0"), ("q", "A4.1")];
    let scan = Interface {
        scan: Some("byte".to_owned()),
        ..with(&[], &right)
    };
    let said = [
        told(&with(&[("E0.0", "A")], &right)),
        told(&with(&[("E0.0", "byte")], &right)),
        told(&with(&[("E0.0", "a"), ("E0.0", "b")], &right)),
        told(&with(&[], &[("p", "A4.0")])),
        told(&with(&[], &[("p", "A4.0"), ("p", "A4.1"), ("r", "A4.0")])),
        told(&with(&[], &[("p", "M9.0"), ("q", "E0.0")])),
        told(&scan),
    ];
    insta::assert_snapshot!(said.join("---\n"));
}
