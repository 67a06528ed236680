//! `stillpoint explore`: the interface over HTTP, and the page in a browser.

mod adversary;
mod agreement;
mod api;
mod chromium;
mod count;
mod page;
mod recording;
mod served;
