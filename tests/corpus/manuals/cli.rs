//! Cases that go through the command line, as a user meets them.

use super::case::Given;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;
use std::process::Command;
use toml::{Table, Value};

/// Runs the command `stillpoint`.
///
/// Given: `arguments`, in which `FILE` stands for the machine file and `SCENARIO` for the scenario; `machine`, a file of the
/// workspace, or `file`, the text of one, in which `FAMILIES` is the folder of the families; `replace`, pairs of texts, each replaced
/// in it where it stands first; `scenario`, the text of one; `find`, texts looked for in both outputs;
/// `json`, pointers into the standard output, taken as JSON. Answer: `status`, `found` (those of `find` that were found), and
/// each pointer of `json`.
pub fn run(given: &Given<'_>) -> Result<Table, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut text = match given.get("file") {
        Some(text) => {
            let text = text.as_str().ok_or("file: a text is needed")?;
            text.replace("FAMILIES", &root.join("spec/families").to_string_lossy())
        }
        None => {
            std::fs::read_to_string(root.join(given.text("machine")?)).map_err(|e| e.to_string())?
        }
    };
    for pair in given.texts("replace")?.chunks(2) {
        let [from, to] = pair else {
            return Err("replace: pairs are needed".into());
        };
        if !text.contains(from) {
            return Err(format!("replace: the file has no {from}"));
        }
        text = text.replacen(from, to, 1);
    }
    let scenario = match given.get("scenario") {
        Some(text) => Some(text.as_str().ok_or("scenario: a text is needed")?),
        None => None,
    };
    // A folder of its own for every case, inside the workspace so that the family is found.
    let folder = tempfile_folder(&(&text, scenario))?;
    let write = |name, text: &str| {
        let file = folder.join(name);
        std::fs::write(&file, text).map_err(|e| e.to_string())?;
        Ok::<_, String>(file)
    };
    let mut files = vec![("FILE", write("machine.toml", &text)?)];
    if let Some(text) = scenario {
        files.push(("SCENARIO", write("scenario.toml", text)?));
    }
    let arguments = given.texts("arguments")?;
    let output = Command::new(env!("CARGO_BIN_EXE_stillpoint"))
        .args(arguments.iter().map(|argument| {
            let file = files.iter().find(|(name, _)| name == argument);
            file.map_or(argument.as_ref(), |(_, file)| file.as_os_str())
        }))
        .current_dir(&root)
        .env("NO_COLOR", "1")
        .output()
        .map_err(|e| e.to_string());
    let _ = std::fs::remove_dir_all(&folder);
    let output = output?;
    let (out, err) = (
        String::from_utf8_lossy(&output.stdout).into_owned(),
        String::from_utf8_lossy(&output.stderr).into_owned(),
    );
    let mut answer = Table::new();
    answer.insert(
        "status".into(),
        i64::from(output.status.code().ok_or("ended by a signal")?).into(),
    );
    let found = given
        .texts("find")?
        .into_iter()
        .filter(|t| out.contains(t) || err.contains(t));
    answer.insert(
        "found".into(),
        found
            .map(|t| Value::from(t.to_owned()))
            .collect::<Vec<_>>()
            .into(),
    );
    let pointers = given.texts("json")?;
    if !pointers.is_empty() {
        let json: serde_json::Value =
            serde_json::from_str(&out).map_err(|e| format!("no JSON: {e}\n{err}"))?;
        for pointer in pointers {
            let value = json
                .pointer(pointer)
                .ok_or(format!("nothing at {pointer}"))?;
            let value = Value::try_from(value).map_err(|e| e.to_string())?;
            answer.insert(pointer.to_owned(), value);
        }
    }
    Ok(answer)
}

fn tempfile_folder(texts: &impl Hash) -> Result<std::path::PathBuf, String> {
    let mut hasher = DefaultHasher::new();
    (
        texts,
        std::process::id(),
        format!("{:?}", std::thread::current().id()),
    )
        .hash(&mut hasher);
    let folder =
        Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("corpus-{:016x}", hasher.finish()));
    std::fs::create_dir_all(&folder).map_err(|e| e.to_string())?;
    Ok(folder)
}
