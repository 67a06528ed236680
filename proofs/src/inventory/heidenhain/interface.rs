//! What the kernel takes over from the safe PLC.

use crate::inventory::NARROW;

inventory! {
    [contract hfs_gate_contract on heidenhain::gate {
        property: "every clause of the take-over's contract: unknown codes, the state of a spindle for other groups, activation",
        domain: NARROW,
        domain_text: "every kind of group; every code, the first beyond the codes and 255; both signals",
        caveat: "codes between are drawn at random and taken by Kani; the code only asks whether one is known",
    }]
    [contract hfs_both_channels_contract on heidenhain::both_channels {
        property: "every clause of the joining's contract: the stricter request, the higher stop, permissions of both",
        domain: NARROW,
        domain_text: "complete: every input",
        caveat: "how long the channels may differ is decided elsewhere",
    }]
    [contract hfs_both_fields_contract on heidenhain::both_fields {
        property: "every clause of the contract of the general fields of both channels: what is compared, what is in force",
        domain: NARROW,
        domain_text: "complete: every pair of fields that a kernel takes over",
        caveat: "how long the channels may differ is decided elsewhere",
    }]
    [contract hfs_both_status_contract on heidenhain::both_status {
        property: "every clause of the contract of programs, run-time systems and outputs of both channels",
        domain: NARROW,
        domain_text: "both signals of each channel; outputs none, each of two, both, all",
        caveat: "other combinations of outputs are taken by Kani; the code only asks whether they are equal",
    }]
}
