//! The harness of the composition.

use crate::enumeration::Domain;

inventory! {
    [contract [parts(3: first = 1, second = 2, third = 3)] hfs_channel_contract on heidenhain::channel {
        property: "every law of the channel: each cause acts in its cycle, requests are not trusted, release and restart need both channels and the operator",
        domain: Domain { delays: &[1, 2], highest_speed: 0 },
        domain_text: "three parts: requests of both channels; stops; drive permission. Times 1 or 2 cycles; the states and inputs of the part in every combination, the others quiet",
        caveat: "the enumeration is complete within each part only; the whole product is drawn at random and is what Kani takes",
    }]
}
