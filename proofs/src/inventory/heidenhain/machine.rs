//! What concerns the whole machine: modes, permissives, control voltage, outputs.

inventory! {
    [contract hfs_som_contract on heidenhain::som {
        property: "every clause of the mode selection's contract: one key, SOM_4 from and to SOM_1 only, lock, soft key",
        tries: "",
        caveat: "the contacts are combined and their pulses filtered outside",
    }]
    [contract hfs_button_contract on heidenhain::button {
        property: "every clause of the permissive's contract: both contacts, edge, time, jam, change of the unit",
        tries: "t_max: 1 2 4; timer: 0..4",
        caveat: "longer times only under Kani and in samples",
    }]
    [contract hfs_switch_on_contract on heidenhain::switch_on {
        property: "every clause of the control voltage's contract: edge, chain, drop by a stop, loss",
        tries: "t_chain: 1 2 4; timer: 0..4",
        caveat: "which stops drop -STO.A.G is decided outside",
    }]
    [contract hfs_output_enable_contract on heidenhain::output_enable {
        property: "every clause of the permission's contract: SS0, standstill, deadline, no other cause, restart",
        tries: "t_off: 1 2 4; timer: 0..4",
        caveat: "longer times only under Kani and in samples",
    }]
}
