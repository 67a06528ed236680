//! The page as its user meets it: keys, clicks, links.

use super::api::FILE;
use super::chromium::{Page, available};
use super::served::Served;

/// Waits until the page shows this cycle of this walk.
fn shows(page: &mut Page, path: &str, at: usize) {
    page.wait(&format!("document.body.dataset.ready === '{path}@{at}'"));
}

fn cell(page: &mut Page, name: &str) -> String {
    page.text(&format!(
        "document.querySelector('.states [data-name=\"{name}\"] .value').lastChild.textContent"
    ))
}

/// Nothing makes the page scroll sideways.
fn fits(page: &mut Page, width: u64, file: &str) {
    let needed = page.value("document.documentElement.scrollWidth");
    assert!(
        needed.as_u64().is_some_and(|n| n <= width),
        "{file}: {needed} pixels of {width}"
    );
}

fn standing(page: &mut Page) -> String {
    page.text("document.querySelector('[data-id=\"S840D-P-05\"]').dataset.standing")
}

#[test]
fn a_walk_by_keys_clicks_and_links() {
    if !available() {
        return;
    }
    let served = Served::start(&[FILE]);
    let mut page = Page::open("walk", 1280, 900);
    page.visit(&served.url);
    shows(&mut page, "0", 0);
    assert_eq!(cell(&mut page, "level"), "NONE");
    assert_eq!(
        page.value("document.querySelectorAll('#classes li').length"),
        2
    );

    // Digits make cycles; the property breaks in the fourth.
    page.press("2");
    shows(&mut page, "0.1", 1);
    assert_eq!(
        (cell(&mut page, "level"), cell(&mut page, "timer")),
        ("B".to_owned(), "2".to_owned())
    );
    assert_eq!(standing(&mut page), "pending");
    for (path, at) in [("0.1.0", 2), ("0.1.0*2", 3), ("0.1.0*3", 4)] {
        page.press("1");
        shows(&mut page, path, at);
    }
    assert_eq!(standing(&mut page), "broken");
    let svg = page.text("document.querySelector('#diagram svg').textContent");
    assert!(svg.contains("S840D-P-05 violated"), "{svg}");
    page.shot("walk-1280");

    // Along the walk and back.
    for (key, at) in [
        ("Backspace", 3),
        ("ArrowLeft", 2),
        ("Home", 0),
        ("ArrowRight", 1),
        ("End", 4),
        ("ArrowLeft", 3),
    ] {
        page.press(key);
        shows(&mut page, "0.1.0*3", at);
    }
    assert_eq!(standing(&mut page), "pending");

    // The link shows the same to anybody; so does a reload.
    let link = page.text("location.href");
    let before = page.text("document.getElementById('state').innerText");
    let mut other = Page::open("link", 400, 800);
    other.visit(&link);
    shows(&mut other, "0.1.0*3", 3);
    other.call("Page.reload", serde_json::json!({}));
    other.wait("performance.getEntriesByType('navigation')[0].type === 'reload'");
    shows(&mut other, "0.1.0*3", 3);
    other.size(1280, 900, "light");
    assert_eq!(
        other.text("document.getElementById('state').innerText"),
        before
    );

    // Another step from the middle begins a new walk; the browser's Back leads to the old one.
    page.press("ArrowDown");
    page.wait("document.querySelector('#classes li.chosen button').dataset.choice === '1'");
    page.press("Enter");
    shows(&mut page, "0.1.0*2.1", 4);
    assert_eq!(cell(&mut page, "level"), "A");
    assert_eq!(standing(&mut page), "met");
    page.value("history.back()");
    shows(&mut page, "0.1.0*3", 3);

    // The mouse.
    page.click("#first");
    shows(&mut page, "0.1.0*3", 0);
    page.click("#classes button[data-choice='0']");
    shows(&mut page, "0.0", 1);

    // Keys are told on a page of their own, and do nothing behind it.
    page.press("?");
    page.wait("document.getElementById('help').open");
    page.press("Backspace");
    page.press("Escape");
    page.wait("!document.getElementById('help').open");
    assert_eq!(page.text("document.body.dataset.ready"), "0.0@1");
    assert_eq!(
        (page.errors.as_slice(), other.errors.as_slice()),
        (&[][..], &[][..])
    );
}

#[test]
fn the_counterexample_on_request_and_inputs_held() {
    if !available() {
        return;
    }
    let served = Served::start(&[FILE]);
    let mut page = Page::open("jump", 1280, 900);
    page.visit(&served.url);
    shows(&mut page, "0", 0);
    page.click("[data-id='S840D-P-05'] summary");
    page.click("[data-run='S840D-P-05']");
    shows(&mut page, "0.1.0*3", 4);
    let notice = page.text("document.getElementById('notice').textContent");
    assert!(
        notice.contains("Violated") && notice.contains("Counterexample: 4 cycles"),
        "{notice}"
    );
    assert_eq!(standing(&mut page), "broken");

    // The control states, with the present one marked; it follows the walk.
    page.click("#control summary");
    page.wait("document.querySelectorAll('#graphs g.node').length === 3");
    let present = "[...document.querySelectorAll('#graphs .present')].map(n => n.querySelector('text').textContent).join()";
    page.wait(&format!("{present} === 'B'"));
    page.shot("control-1280");
    page.press("Home");
    shows(&mut page, "0.1.0*3", 0);
    page.wait(&format!("{present} === 'NONE'"));

    page.click("#hold summary");
    page.value(
        "(() => { const s = document.querySelector('#inputs select'); s.value = '1'; s.dispatchEvent(new Event('change')); })()",
    );
    page.wait("document.querySelectorAll('#classes li').length === 1");
    assert!(page.text("location.hash").contains("held=0%3D1"));
    page.press("1");
    shows(&mut page, "0.1.0*3", 1);
    assert_eq!(page.errors, Vec::<String>::new());
}

#[test]
fn a_link_that_does_not_fit_says_why() {
    if !available() {
        return;
    }
    let served = Served::start(&[FILE]);
    let mut page = Page::open("refused", 400, 800);
    page.visit(&served.url);
    shows(&mut page, "0", 0);
    let own = page.text("location.hash");
    let hash = own
        .split("spec=")
        .nth(1)
        .and_then(|rest| rest.split('&').next());
    let other = own.replace(hash.expect("a hash"), "0123456789abcdef");
    let other = other.replace("path=0", "path=0.1");

    page.visit(&format!("{}{other}", served.url));
    page.wait("document.body.dataset.ready === 'refused'");
    let told = page.text("document.getElementById('refused').innerText");
    assert!(
        told.contains("another specification") && told.contains("0123456789abcdef"),
        "{told}"
    );
    page.shot("refused-400");
    page.click("#anyway");
    shows(&mut page, "0.1", 1);

    let wrong = own.replace("path=0", "path=0.7%3Cimg%20src%3Dx%20onerror%3Dalert(1)%3E");
    page.visit(&format!("{}{wrong}", served.url));
    page.wait("document.body.dataset.ready === 'refused'");
    let told = page.text("document.getElementById('refused').innerText");
    assert!(told.contains("part 1 of the path"), "{told}");
    assert_eq!(page.value("document.images.length"), 0);
    page.click("#begin");
    shows(&mut page, "0", 0);
    assert_eq!(page.errors, Vec::<String>::new());
}

#[test]
fn of_many_outcomes_some_are_shown_and_a_filter_finds_others() {
    if !available() {
        return;
    }
    let served = Served::start(&["spec/families/sinumerik-840d/axis.toml", "--system", "stop"]);
    let mut page = Page::open("filter", 1280, 900);
    page.visit(&served.url);
    shows(&mut page, "0", 0);
    let shown = "document.querySelectorAll('#classes button[data-choice]').length";
    assert_eq!(page.value(shown), 60);
    // So it is with properties: what is not asked now is folded away, but there.
    let properties = "document.querySelectorAll('#judged .property').length";
    let folded = "document.querySelectorAll('#rest .property').length";
    assert_eq!(page.value(properties), page.value(folded));
    assert!(page.value(folded).as_u64().is_some_and(|n| n > 20));
    page.click("#more");
    page.wait(&format!("{shown} > 60"));
    page.click("#filter");
    page.call(
        "Input.insertText",
        serde_json::json!({ "text": "no such thing" }),
    );
    page.wait("document.querySelector('#classes').textContent.includes('No outcome fits')");
    page.value("document.getElementById('filter').value = ''");
    page.call(
        "Input.insertText",
        serde_json::json!({ "text": "fault.discrepancy = true" }),
    );
    page.wait(&format!("{shown} > 0"));
    page.value("document.getElementById('filter').blur()");
    page.press("1");
    page.wait("document.getElementById('position').textContent.startsWith('Cycle 1 ')");
    let made = page.text("document.getElementById('made').textContent");
    assert!(made.contains("fault.discrepancy = TRUE"), "{made}");
    assert_eq!(page.errors, Vec::<String>::new());
}

#[test]
fn nothing_is_wider_than_a_small_screen() {
    if !available() {
        return;
    }
    for (name, file) in [
        ("small", FILE),
        ("axis", "spec/families/sinumerik-840d/axis.toml"),
    ] {
        let served = Served::start(&[file]);
        let mut page = Page::open(name, 400, 800);
        page.visit(&served.url);
        shows(&mut page, "0", 0);
        for colours in ["light", "dark"] {
            page.size(400, 800, colours);
            for step in 1..=3 {
                page.press("1");
                page.wait(&format!(
                    "document.getElementById('position').textContent.startsWith('Cycle {step} ')"
                ));
            }
            fits(&mut page, 400, file);
            page.shot(&format!("{name}-400-{colours}"));
            page.size(1280, 900, colours);
            fits(&mut page, 1280, file);
            page.shot(&format!("{name}-1280-{colours}"));
            page.press("Home");
            page.wait("document.getElementById('position').textContent.startsWith('Cycle 0 ')");
        }
        assert_eq!(page.errors, Vec::<String>::new(), "{file}");
    }
}
