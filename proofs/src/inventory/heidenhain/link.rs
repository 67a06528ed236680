//! Telegrams between controller computers.

use crate::inventory::NARROW;

inventory! {
    [contract hfs_cc_link_contract on heidenhain::cc_link {
        property: "every clause of the contract of the CC-CC telegrams: what counts, motion while they are faulty, SS1F after the fourth",
        domain: NARROW,
        domain_text: "positions -1 to 1 and the ends of 32 bits, no group and two groups; every configuration, consistent state and input",
        caveat: "how a telegram is found to be faulty is outside; which stop it is, is a reading",
    }]
}
