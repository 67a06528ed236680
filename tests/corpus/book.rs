//! The book: every page is in its table of contents, every link leads somewhere, the pages made from the specification are
//! up to date.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};
use std::sync::OnceLock;

use stillpoint_harness::families::FAMILIES;
use stillpoint_harness::pages::{Written, differences, pages};
use stillpoint_tests::{exceptions, root};

/// What matters of a page: where it links to, and which anchors it has.
#[derive(Default)]
struct Page {
    links: Vec<String>,
    anchors: BTreeSet<String>,
}

/// Reads Markdown as mdBook does; its anchors are those that mdBook makes of headings, and those that are stated.
fn read(text: &str) -> Page {
    let mut page = Page::default();
    let mut heading: Option<String> = None;
    let mut used: BTreeMap<String, usize> = BTreeMap::new();
    for event in Parser::new_ext(text, Options::ENABLE_TABLES) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                let id = slug(&heading.take().unwrap_or_default());
                let count = used.entry(id.clone()).or_insert(0);
                page.anchors.insert(match *count {
                    0 => id,
                    n => format!("{id}-{n}"),
                });
                *count += 1;
            }
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                page.links.push(dest_url.to_string());
            }
            Event::Text(text) | Event::Code(text) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&text);
                }
            }
            Event::Html(html) | Event::InlineHtml(html) => {
                let stated = html.split("id=\"").skip(1);
                let stated = stated.filter_map(|rest| rest.split('"').next());
                page.anchors.extend(stated.map(str::to_owned));
            }
            _ => {}
        }
    }
    page
}

fn slug(heading: &str) -> String {
    heading
        .trim()
        .chars()
        .filter_map(|c| match c {
            c if c.is_whitespace() => Some('-'),
            c if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_ascii_lowercase()),
            _ => None,
        })
        .collect()
}

/// The files below a folder with one of these extensions, relative to it.
fn below(folder: &Path, extensions: &[&str]) -> BTreeSet<PathBuf> {
    let mut open = vec![folder.to_owned()];
    let mut found = BTreeSet::new();
    while let Some(dir) = open.pop() {
        for entry in std::fs::read_dir(&dir).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path
                .extension()
                .is_some_and(|e| extensions.iter().any(|x| *x == e))
            {
                found.insert(path.strip_prefix(folder).expect("below").to_owned());
            }
        }
    }
    found
}

/// A path without `.` and `..`; none if it leaves the folder that it is relative to.
fn plain(path: &Path) -> Option<PathBuf> {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => out.push(name),
            Component::CurDir => {}
            Component::ParentDir if out.pop() => {}
            _ => return None,
        }
    }
    Some(out)
}

/// The links of these pages that lead nowhere. `others` are files that may be linked to as well.
fn broken(pages: &BTreeMap<PathBuf, Page>, others: &BTreeSet<PathBuf>) -> Vec<String> {
    let mut out = Vec::new();
    for (from, page) in pages {
        for link in &page.links {
            if link.contains("://") || link.starts_with("mailto:") {
                continue;
            }
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = match file {
                "" => Some(from.clone()),
                file => plain(&from.parent().unwrap_or(Path::new("")).join(file)),
            };
            let reached = target
                .as_ref()
                .is_some_and(|target| match pages.get(target) {
                    Some(page) => anchor.is_empty() || page.anchors.contains(anchor),
                    None => anchor.is_empty() && others.contains(target),
                });
            if !reached {
                out.push(format!("{}: {link}", from.display()));
            }
        }
    }
    out
}

fn read_all(folder: &Path, names: &BTreeSet<PathBuf>) -> BTreeMap<PathBuf, Page> {
    let text = |name: &PathBuf| std::fs::read_to_string(folder.join(name)).expect("UTF-8");
    names.iter().map(|n| (n.clone(), read(&text(n)))).collect()
}

#[test]
fn every_link_of_the_book_leads_somewhere() {
    let folder = root().join("docs/src");
    let pages = read_all(&folder, &below(&folder, &["md"]));
    assert!(pages.len() > 15 && pages.values().map(|p| p.links.len()).sum::<usize>() > 50);
    let lost = broken(&pages, &below(&folder, &["svg"]));
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}

#[test]
fn every_link_of_the_readme_leads_somewhere() {
    let folder = root();
    let name = PathBuf::from("README.md");
    let page = read_all(&folder, &BTreeSet::from([name]));
    assert!(page.values().all(|p| p.links.len() > 5));
    for link in page.values().flat_map(|p| &p.links) {
        let path = link.split('#').next().unwrap_or(link);
        let there = path.contains("://") || path.is_empty() || folder.join(path).exists();
        assert!(there, "README.md: {link}");
    }
}

#[test]
fn every_page_is_in_the_table_of_contents_once() {
    let folder = root().join("docs/src");
    let summary = std::fs::read_to_string(folder.join("SUMMARY.md")).expect("SUMMARY.md");
    let mut listed = read(&summary).links;
    listed.sort();
    let mut there: Vec<String> = (below(&folder, &["md"]).iter())
        .map(|path| path.display().to_string())
        .filter(|path| path != "SUMMARY.md")
        .collect();
    there.sort();
    assert_eq!(listed, there);
}

#[test]
fn a_broken_link_is_found() {
    let page = |text: &str, name: &str| (PathBuf::from(name), read(text));
    let pages = BTreeMap::from([
        page(
            "# A `b` c\n\n## A b c\n\n[x](sub/b.md#y) [z](#a-b-c-1) ![p](p.svg)",
            "a.md",
        ),
        page("# <a id=\"y\"></a>Y\n\n[up](../a.md#a-b-c)", "sub/b.md"),
    ]);
    let others = BTreeSet::from([PathBuf::from("p.svg")]);
    assert_eq!(broken(&pages, &others), Vec::<String>::new());
    let wrong = BTreeMap::from([page(
        "# A\n\n[1](b.md) [2](#b) [3](../a.md) ![4](q.svg) [5](a.md#a)",
        "a.md",
    )]);
    assert_eq!(
        broken(&wrong, &others),
        ["a.md: b.md", "a.md: #b", "a.md: ../a.md", "a.md: q.svg"]
    );
}

/// The pages of the family, made once.
fn made() -> &'static [Written] {
    static MADE: OnceLock<Vec<Written>> = OnceLock::new();
    MADE.get_or_init(|| {
        pages(&root().join("spec/families/sinumerik-840d")).unwrap_or_else(|e| panic!("{e}"))
    })
}

#[test]
fn the_pages_of_the_safety_functions_are_up_to_date() {
    let made = made();
    let names: BTreeSet<&str> = made.iter().map(|w| w.name.as_str()).collect();
    assert!(
        names.contains("stop.md") && names.contains("stop-1.svg"),
        "{names:?}"
    );
    let without = exceptions("family without machine files");
    for family in FAMILIES.iter().filter(|f| !without.contains(f.name)) {
        let other = match family.name {
            "sinumerik-840d" => None,
            name => Some(pages(&root().join("spec/families").join(name))),
        };
        let other = other.map(|made| made.unwrap_or_else(|e| panic!("{e}")));
        let (family, made) = (family.name, other.as_deref().unwrap_or(made));
        let folder = root().join("docs/src/functions").join(family);
        let different = differences(&folder, made);
        assert!(
            different.is_empty(),
            "{}\nrun: stillpoint pages spec/families/{family} --output docs/src/functions",
            different.join("\n")
        );
    }
}

#[test]
fn a_page_that_is_old_missing_or_left_over_is_told() {
    let made = made();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pages");
    std::fs::create_dir_all(&folder).expect("a folder");
    for file in made.iter().skip(1) {
        std::fs::write(folder.join(&file.name), &file.text).expect("written");
    }
    std::fs::write(folder.join(&made[1].name), "old").expect("written");
    std::fs::write(folder.join("gone.md"), "left over").expect("written");
    assert_eq!(
        differences(&folder, made),
        [
            format!("{} is missing", made[0].name),
            format!("{} differs", made[1].name),
            "gone.md is not made by this command".to_owned(),
        ]
    );
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// The report folds the inventory of the proofs away: each harness of the page is a row of it.
#[test]
fn every_harness_of_the_page_is_a_row_of_the_report() {
    let page = std::fs::read_to_string(root().join("docs/src/proofs.md")).expect("the page");
    let said = page.split(" harnesses,").next();
    let said = said.and_then(|before| before.rsplit(' ').next()?.parse::<usize>().ok());
    let rows = stillpoint_harness::report::inventory::rows();
    assert_eq!(Some(rows.len()), said);
    assert!(rows.iter().all(|row| row.len() == 7), "seven cells each");
}
