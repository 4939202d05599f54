//! The form of `examples/components`, whose build systems are not installed here: keys are documented ones,
//! files that are named are there, and settings that a build file reads exist.

use crate::source::{root, text};
use serde::Deserialize;
use std::collections::BTreeMap;

const FOLDER: &str = "examples/components";

/// Keys of PlatformIO's `library.json`, from its documentation.
const LIBRARY_KEYS: [&str; 18] = [
    "authors",
    "build",
    "dependencies",
    "description",
    "examples",
    "export",
    "frameworks",
    "headers",
    "homepage",
    "keywords",
    "license",
    "name",
    "platforms",
    "repository",
    "scripts",
    "version",
    "downloadUrl",
    "$schema",
];
/// Fields of an Arduino library that its specification asks for.
const ARDUINO_FIELDS: [&str; 9] =
    ["name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures"];
/// Settings that build files read.
const SETTINGS: [&str; 5] = ["METHOD", "WIDTH", "DISPARITIES", "HEIGHT", "LINES"];

/// A Zephyr module, of the keys that its documentation has.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Module {
    name: String,
    build: ModuleBuild,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModuleBuild {
    cmake: String,
    kconfig: String,
}

/// An ESP-IDF component, of the keys that its component manager's documentation has.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Component {
    version: String,
    #[serde(rename = "description")]
    _description: String,
    license: String,
    targets: Vec<String>,
    dependencies: BTreeMap<String, String>,
}

fn of(path: &str) -> String {
    text(&format!("{FOLDER}/{path}"))
}

/// The crate's version and licence.
fn crate_says(key: &str) -> String {
    let manifest = text("Cargo.toml");
    let line = manifest.lines().find_map(|line| line.strip_prefix(&format!("{key} = ")));
    line.expect("the workspace has it").trim_matches('"').to_owned()
}

#[test]
fn the_zephyr_module_names_its_files() {
    let module: Module = serde_saphyr::from_str(&of("zephyr/zephyr/module.yml")).expect("a module");
    assert_eq!(module.name, "stereopsis");
    for file in [format!("{}/CMakeLists.txt", module.build.cmake), module.build.kconfig] {
        assert!(root().join(FOLDER).join("zephyr").join(&file).is_file(), "{file}");
    }
}

#[test]
fn the_esp_idf_component_says_what_it_is() {
    let component: Component =
        serde_saphyr::from_str(&of("esp-idf/stereopsis/idf_component.yml")).expect("a component");
    assert_eq!(component.version, crate_says("version"));
    assert_eq!(component.license, crate_says("license"));
    assert!(component.dependencies.contains_key("idf"));
    // The build file has Rust's target of each.
    let build = of("esp-idf/stereopsis/CMakeLists.txt");
    for target in component.targets {
        let kind = target.strip_prefix("esp32").expect("a chip of Espressif's");
        let is_known = build.contains(&format!("\"{target}\""))
            || build.lines().any(|line| {
                let kinds = line.split("^esp32(").nth(1).and_then(|rest| rest.split(')').next());
                kinds.is_some_and(|kinds| kinds.split('|').any(|known| known == kind))
            });
        assert!(is_known, "{target}");
    }
}

#[test]
fn settings_are_declared_and_blocks_closed() {
    for path in ["zephyr/zephyr", "esp-idf/stereopsis"] {
        let settings = of(&format!("{path}/Kconfig"));
        let mut open = Vec::new();
        for line in settings.lines() {
            let word = line.split_whitespace().next().unwrap_or_default();
            match word {
                "menu" | "choice" | "if" => open.push(word),
                "endmenu" | "endchoice" | "endif" => {
                    assert_eq!(open.pop(), word.strip_prefix("end"), "{path}: {line}");
                }
                _ => {}
            }
        }
        assert!(open.is_empty(), "{path}: {open:?}");
        let build = of(&format!("{path}/CMakeLists.txt"));
        assert!(build.contains(&format!("foreach(choice {})", SETTINGS.join(" "))), "{path}");
        for setting in SETTINGS {
            let declared = settings.lines().any(|line| line.trim() == format!("config STEREOPSIS_{setting}"));
            assert!(declared, "{path}: {setting}");
        }
        // All methods can be chosen.
        for method in ["fast", "block", "sgm-lean", "sgm", "sgm-edge"] {
            assert!(settings.contains(&format!("default \"{method}\"")), "{path}: {method}");
        }
    }
}

#[test]
fn the_libraries_manifests_have_documented_keys() {
    let library: BTreeMap<String, serde_json::Value> =
        serde_json::from_str(&of("platformio/library.json")).expect("an object");
    for key in library.keys() {
        assert!(LIBRARY_KEYS.contains(&key.as_str()), "{key}");
    }
    assert_eq!(library["version"], crate_says("version"));
    let script = library["build"]["extraScript"].as_str().expect("a script");
    assert!(root().join(FOLDER).join("platformio").join(script).is_file());
    let arduino = of("platformio/library.properties");
    let fields: BTreeMap<_, _> = arduino.lines().filter_map(|line| line.split_once('=')).collect();
    for field in ARDUINO_FIELDS {
        assert!(fields.contains_key(field), "{field}");
    }
    assert_eq!(fields["version"], crate_says("version"));
}
