//! Telegrams between controller computers.

inventory! {
    [contract hfs_cc_link_contract on heidenhain::cc_link {
        property: "every clause of the contract of the CC-CC telegrams: what counts, motion while they are faulty, SS1F after the fourth",
        tries: "tolerated faulty: 0..4; group.value: 0 7; position: -1..1 ends",
        caveat: "how a telegram is found to be faulty is outside; which stop it is, is a reading",
    }]
}
