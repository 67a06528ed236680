//! The safe PLC program.

use crate::inventory::NARROW;

inventory! {
    [contract hfs_program_check_contract on heidenhain::program_check {
        property: "every clause of the contract of the program's check: another checksum or version does not run and is reported",
        domain: NARROW,
        domain_text: "complete: every configuration, state and input",
        caveat: "the checksums themselves are outside; that such a program does not run is a reading, the manual names the messages",
    }]
}
