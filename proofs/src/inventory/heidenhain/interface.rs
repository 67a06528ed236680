//! What the kernel takes over from the safe PLC.

inventory! {
    [contract hfs_gate_contract on heidenhain::gate {
        property: "every clause of the take-over's contract: unknown codes, the state of a spindle for other groups, activation",
        tries: "state_code: 0..8 max; stop_code: 0..5 max; som_code: 0..4 max",
        caveat: "codes between are drawn at random and taken by Kani; the code only asks whether one is known",
    }]
    [contract hfs_both_channels_contract on heidenhain::both_channels {
        property: "every clause of the joining's contract: the stricter request, the higher stop, permissions of both",
        tries: "",
        caveat: "how long the channels may differ is decided elsewhere",
    }]
    [contract hfs_both_fields_contract on heidenhain::both_fields {
        property: "every clause of the contract of the general fields of both channels: what is compared, what is in force",
        tries: "",
        caveat: "how long the channels may differ is decided elsewhere",
    }]
    [contract hfs_both_status_contract on heidenhain::both_status {
        property: "every clause of the contract of programs, run-time systems and outputs of both channels",
        tries: "outputs: 0..3 max",
        caveat: "other combinations of outputs are taken by Kani; the code only asks whether they are equal",
    }]
}
