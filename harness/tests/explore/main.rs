//! `stillpoint explore`: the interface over HTTP, and the page in a browser.

mod agreement;
mod api;
mod chromium;
mod count;
mod page;
mod served;
