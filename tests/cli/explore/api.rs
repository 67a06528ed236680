//! The interface: what it tells about walks, and what it refuses.

use serde_json::{Value, json};

use super::served::Served;

/// STOP B without its timer: `level` NONE, B, A and `timer`; the inputs `demand_b` and `standstill`.
pub const FILE: &str = "tests/must-fail/stop-b-without-timer.toml";

fn names(list: &Value, key: &str) -> Vec<String> {
    let items = list.as_array().expect("a list").iter();
    items
        .map(|i| i[key].as_str().expect("text").to_owned())
        .collect()
}

#[test]
fn the_classes_of_the_initial_state() {
    let served = Served::start(&[FILE]);
    let systems = served.systems();
    let system = &systems["systems"][0];
    assert_eq!(systems["start"], system["name"]);
    assert_eq!(
        names(&system["inputs"], "name"),
        ["stop.demand_b", "stop.standstill"]
    );

    let view = served.view(json!({ "path": "" }));
    assert_eq!((&view["path"], &view["at"]), (&json!("0"), &json!(0)));
    let next = &view["next"];
    assert_eq!(
        (&next["combinations"], &next["cycles"]),
        (&json!("4"), &json!(2))
    );
    let classes = next["classes"].as_array().expect("classes");
    assert_eq!(classes.len(), 2);
    assert_eq!(classes[0]["changes"], json!([]));
    assert_eq!(classes[1]["choice"], "1");
    assert_eq!(classes[1]["combinations"], "2");
    assert_eq!(
        (&classes[1]["when"], &classes[1]["exact"]),
        (&json!([["stop.demand_b", ["TRUE"], false]]), &json!(true))
    );
    assert_eq!(
        classes[1]["changes"],
        json!([["stop.level", "NONE", "B"], ["stop.timer", "0", "2"]])
    );
    assert_eq!(
        system["rules"][classes[1]["rules"][0].as_u64().expect("a number") as usize]["name"],
        "stop.starts"
    );

    // With the demand held, one class is left.
    let view = served.view(json!({ "path": "", "held": "0=1" }));
    let classes = &view["next"]["classes"];
    assert_eq!(names(classes, "choice"), ["1"]);
    assert_eq!(view["next"]["combinations"], "2");
}

#[test]
fn properties_follow_the_walk_to_the_counterexample_that_exploring_finds() {
    let served = Served::start(&[FILE]);
    let run = served.about(json!({ "property": "S840D-P-05" }));
    let run = served.json(&served.post("/api/run", &run));
    assert_eq!(
        (&run["verdict"], &run["path"]),
        (&json!("violated"), &json!("0.1.0*3"))
    );

    let standing = |at: usize| {
        let view = served.view(json!({ "path": "0.1.0*3", "at": at }));
        let property = &view["properties"][0];
        (
            property["standing"].as_str().expect("text").to_owned(),
            property["text"].as_str().expect("text").to_owned(),
            property["broken"].clone(),
        )
    };
    assert_eq!(standing(0).0, "none");
    let pending = |text: &str| {
        (
            "pending".to_owned(),
            format!("pending since cycle 1, {text}"),
            Value::Null,
        )
    };
    assert_eq!(standing(1), pending("3 cycles left"));
    assert_eq!(standing(3), pending("1 cycle left"));
    assert_eq!(
        standing(4),
        (
            "broken".to_owned(),
            "violated in this cycle".to_owned(),
            json!(4)
        )
    );
    let view = served.view(json!({ "path": "0.1.0*3" }));
    let svg = view["diagram"].as_str().expect("a diagram");
    assert!(
        svg.starts_with("<svg") && svg.contains("S840D-P-05 violated"),
        "{svg}"
    );
    let file = served.post("/api/diagram", &served.about(json!({ "path": "0.1.0*3" })));
    assert!(
        file.status == 200 && file.head.contains("image/svg+xml") && file.body.starts_with("<svg")
    );
}

#[test]
fn a_run_that_is_not_found_within_the_limit_is_not_called_impossible() {
    let served = Served::start(&[
        "spec/families/sinumerik-840d/axis.toml",
        "--time",
        "1ms",
        "--threads",
        "1",
    ]);
    let systems = served.systems();
    let all = systems["systems"].as_array().expect("systems");
    let limited = all.iter().any(|system| {
        let properties = system["properties"].as_array().expect("properties");
        properties.iter().take(3).any(|property| {
            let body = json!({ "system": system["name"], "hash": system["hash"], "property": property["id"] });
            let run = served.json(&served.post("/api/run", &body.to_string()));
            let text = run["text"].as_str().expect("text");
            run["verdict"] == "inconclusive" && run["path"].is_null() && text.starts_with("Not found, and not excluded")
        })
    });
    assert!(limited, "no exploration met its limit of a millisecond");
}

#[test]
fn requests_that_make_no_sense_are_refused_with_a_reason() {
    let served = Served::start(&[FILE]);
    let about = |more: Value| served.about(more);
    let systems = served.systems();
    let name = &systems["systems"][0]["name"];
    for (address, body, status, reason) in [
        ("/api/view", "".to_owned(), 400, "not understood"),
        ("/api/view", "[1, 2".to_owned(), 400, "not understood"),
        ("/api/view", about(json!({})), 400, "missing field `path`"),
        (
            "/api/view",
            about(json!({ "path": "0", "more": 1 })),
            400,
            "unknown field",
        ),
        (
            "/api/view",
            about(json!({ "path": 7 })),
            400,
            "invalid type",
        ),
        (
            "/api/view",
            about(json!({ "path": "0.2" })),
            400,
            "value 2 of `stop.demand_b`; it has the values 0 to 1",
        ),
        (
            "/api/view",
            about(json!({ "path": "0.11" })),
            400,
            "2 choices are given, 1 are read",
        ),
        ("/api/view", about(json!({ "path": "01.0" })), 400, "part 0"),
        (
            "/api/view",
            about(json!({ "path": "0.0!9=0" })),
            400,
            "no input number 9",
        ),
        (
            "/api/view",
            about(json!({ "path": "0.0!1=2" })),
            400,
            "value 2 of `stop.standstill`",
        ),
        (
            "/api/view",
            about(json!({ "path": "0.1!0=0" })),
            400,
            "`stop.demand_b` has two values",
        ),
        (
            "/api/view",
            about(json!({ "path": "0.<script>" })),
            400,
            "is no value",
        ),
        (
            "/api/view",
            about(json!({ "path": "0.0*99999999" })),
            400,
            "more than 10000 cycles",
        ),
        (
            "/api/view",
            about(json!({ "path": "0", "at": 1 })),
            400,
            "cycle 1 is asked for; the walk has 0",
        ),
        (
            "/api/view",
            about(json!({ "path": "0", "at": -1 })),
            400,
            "not understood",
        ),
        (
            "/api/view",
            about(json!({ "path": "0", "held": "x" })),
            400,
            "to be held",
        ),
        (
            "/api/view",
            about(json!({ "path": "0", "held": "7=0" })),
            400,
            "no input number 7",
        ),
        (
            "/api/view",
            about(json!({ "path": "0", "held": "0=2" })),
            400,
            "the values 0 to 1",
        ),
        (
            "/api/view",
            about(json!({ "path": "0", "held": "0=1!0=0" })),
            400,
            "held twice",
        ),
        (
            "/api/view",
            json!({ "system": "no", "hash": "", "path": "0" }).to_string(),
            404,
            "no system `no`",
        ),
        (
            "/api/view",
            json!({ "system": name, "hash": "0123", "path": "0" }).to_string(),
            409,
            "another specification",
        ),
        (
            "/api/run",
            about(json!({ "property": "P-99" })),
            404,
            "no property `P-99`",
        ),
        (
            "/api/diagram",
            about(json!({ "path": "0.9" })),
            400,
            "value 9",
        ),
        (
            "/api/other",
            String::new(),
            404,
            "nothing under this address",
        ),
        (
            "/page.html/../../Cargo.toml",
            String::new(),
            404,
            "nothing under this address",
        ),
    ] {
        let answer = served.post(address, &body);
        assert_eq!(answer.status, status, "{address} {body}: {}", answer.body);
        let told: Value = serde_json::from_str(&answer.body).expect("JSON");
        let told = told["error"].as_str().expect("a reason");
        assert!(told.contains(reason), "{address} {body}: {told}");
    }
    // It still answers.
    assert_eq!(served.get("/").status, 200);
}

#[test]
fn only_this_host_and_this_page_may_ask() {
    let served = Served::start(&[FILE]);
    let own = format!("Host: {}", served.host());
    let port = served.host().rsplit(':').next().expect("a port").to_owned();
    let get = "GET / HTTP/1.1";
    for (lines, status) in [
        (vec![get.to_owned(), own.clone()], 200),
        (vec![get.to_owned(), format!("Host: localhost:{port}")], 200),
        // A foreign name that somebody has made resolve to loopback.
        (
            vec![get.to_owned(), format!("Host: attacker.example:{port}")],
            403,
        ),
        (
            vec![
                get.to_owned(),
                format!("Host: 127.0.0.1.attacker.example:{port}"),
            ],
            403,
        ),
        (vec![get.to_owned(), "Host: 127.0.0.1:1".to_owned()], 403),
        (vec![get.to_owned()], 403),
        (
            vec![
                get.to_owned(),
                own.clone(),
                "Origin: https://attacker.example".to_owned(),
            ],
            403,
        ),
        (
            vec![
                get.to_owned(),
                own.clone(),
                format!("Origin: http://{}", served.host()),
            ],
            200,
        ),
        (vec!["PUT / HTTP/1.1".to_owned(), own.clone()], 405),
        (vec!["GET /api/view HTTP/1.1".to_owned(), own.clone()], 405),
        (
            vec![
                "POST /api/view HTTP/1.1".to_owned(),
                own.clone(),
                "Content-Length: 0".to_owned(),
            ],
            415,
        ),
        (
            vec![
                "POST /api/view HTTP/1.1".to_owned(),
                own.clone(),
                "Content-Type: text/plain".to_owned(),
                "Content-Length: 0".to_owned(),
            ],
            415,
        ),
    ] {
        let head: Vec<&str> = lines.iter().map(String::as_str).collect();
        let answer = served.raw(&head, b"");
        assert_eq!(answer.status, status, "{head:?}: {}", answer.body);
    }
    let large = "x".repeat((1 << 20) + 1);
    assert_eq!(served.post("/api/view", &large).status, 413);
    let not_text = [
        "POST /api/view HTTP/1.1",
        &own,
        "Content-Type: application/json",
        "Content-Length: 2",
    ];
    assert_eq!(served.raw(&not_text, &[0xff, 0xfe]).status, 400);
    let page = served.get("/");
    assert!(
        page.head
            .contains("Content-Security-Policy: default-src 'none'"),
        "{}",
        page.head
    );
}

#[test]
fn the_command_refuses_what_it_cannot_serve() {
    let run = |arguments: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_stillpoint"))
            .arg("explore")
            .args(arguments)
            .current_dir(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."))
            .env("NO_COLOR", "1")
            .output()
            .expect("the binary runs");
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    let served = Served::start(&[FILE]);
    let port = served.host().rsplit(':').next().expect("a port");
    for (arguments, reason) in [
        (vec!["no-such-file.toml"], "no-such-file.toml"),
        (vec![FILE, "--system", "no"], "there is no system `no`"),
        (vec![FILE, "--system", "2"], "there is no system `2`"),
        (
            vec![FILE, "--readings", "all"],
            "one option of each reading",
        ),
        (
            vec![FILE, "--readings", "A-99=X"],
            "there is no reading `A-99`",
        ),
        (vec![FILE, "--port", "70000"], "70000"),
        (vec![FILE, "--port", port], "choose another --port"),
    ] {
        let (status, told) = run(&arguments);
        assert_eq!(status, Some(2), "{arguments:?}: {told}");
        assert!(told.contains(reason), "{arguments:?}: {told}");
    }
}
