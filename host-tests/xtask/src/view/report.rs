//! The report of a run in a browser: what it says is what the files of the run say.

use super::browser::Browser;
use super::page::{COLOURS, LivePage, failed, hold, numbers, url_of};
use crate::steps::{Failure, Outcome, output_of};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;
use stereopsis::units::PixelFlags;

/// What can be used: ten views, of which two need a truth, two of which need depths; three sliders; the
/// picture.
const CONTROLS: usize = 9 + 3 + 1;
/// Pixels that are read out, spread over the picture.
const PIXELS: usize = 300;

/// Opens a report in a browser and waits until it shows what is in it.
pub fn opened(url: &str) -> Outcome<LivePage> {
    let mut browser = Browser::start()?;
    browser.open(url)?;
    let mut page = LivePage::of(browser);
    page.browser.value(
        "new Promise((done) => { const look = () => state.planes ? done(true) : setTimeout(look, 20); \
         look(); })",
    )?;
    Ok(page)
}

/// Opens the report of `demo` and holds it to the files beside it.
pub fn it_answers_as_the_files_do(run: &Path) -> Outcome {
    let url = url_of(&run.join("report.html"));
    let mut page = opened(&url)?;
    pixels_are_those_of_the_files(&mut page, run)?;
    sliders_change_what_is_said(&mut page, run)?;
    let views =
        page.browser.value("[...document.querySelectorAll('input[name=view]')].map((v) => v.value)")?;
    for view in views.as_array().into_iter().flatten().filter_map(Value::as_str) {
        page.press(&format!("view-{view}"))?;
        let colours = page.browser.value(COLOURS)?;
        let legend = page.text("legend")?;
        hold(colours.as_i64() > Some(2) && !legend.is_empty(), || {
            format!("the report's view {view} is empty")
        })?;
        let name = page.browser.value("canvas.getAttribute('aria-label')")?;
        let due = match view {
            "left" | "right" => format!("{view} picture, {view}.png"),
            view => format!("{view} of left.png and right.png"),
        };
        hold(name == due, || format!("the view {view} is called {name}, not '{due}'"))?;
    }
    without_answers_it_asks_for_nothing(&mut page)?;
    page.press("view-disparity")?;
    page.browser.value("cursor.x = 300; cursor.y = 200; canvas.focus()")?;
    page.key("ArrowDown")?;
    let said = page.text("pixel")?;
    hold(said.starts_with("column 300, row 201: "), || format!("the keys lead to '{said}'"))?;
    the_cursor_is_seen(&mut page)?;
    a_tap_tells_its_pixel(&mut page)?;
    page.keys_reach_everything(CONTROLS)?;
    let requests = page.requests();
    hold(requests == [url.as_str()], || format!("the report asks for {requests:?}"))?;
    let thrown = page.thrown();
    hold(thrown.is_empty(), || format!("not caught in the report: {thrown:?}"))?;
    Ok(())
}

/// Where the sliders keep back all answers, the views say that; a report has no cameras that one could give.
fn without_answers_it_asks_for_nothing(page: &mut LivePage) -> Outcome {
    let ends = page.browser.value("['min', 'max'].map((end) => Number(byId('near')[end]))")?;
    let [low, high] = [0, 1].map(|end| ends[end].as_i64().unwrap_or(0));
    page.set("near", low)?;
    page.set("far", high)?;
    for (view, line) in [
        ("disparity", "No pixel has an answer that is shown."),
        ("depth", "No answer that is shown has a distance."),
        ("points", "No answer that is shown has a distance."),
    ] {
        page.press(&format!("view-{view}"))?;
        let legend = page.text("legend")?;
        hold(legend == line, || format!("without answers {view} says '{legend}'"))?;
    }
    page.set("near", high)?;
    page.set("far", low)
}

/// While keys move the cursor, the picture shows where it is, and not what it is on.
fn the_cursor_is_seen(page: &mut LivePage) -> Outcome {
    let differs = |page: &mut LivePage| {
        page.browser.value(
            "(() => { const { width, height } = canvas; \
             const { data } = context.getImageData(0, 0, width, height); \
             const found = new Uint32Array(data.buffer); const painted = new Uint32Array(image.data.buffer); \
             const other = [...found.keys()].filter((i) => found[i] !== painted[i]); \
             return [other.length, other.reduce((sum, i) => sum + (i % width), 0) / other.length, \
             other.includes(cursor.y * width + cursor.x)]; })()",
        )
    };
    page.browser.value("cursor.x = 300; cursor.y = 200; canvas.focus()")?;
    for (key, column) in [("ArrowLeft", 299.0), ("ArrowRight", 300.0)] {
        page.key(key)?;
        let cross = differs(page)?;
        let middle = cross[1].as_f64().unwrap_or(f64::NAN);
        let is_there = cross[0].as_u64() > Some(8) && (middle - column).abs() < 0.5 && cross[2] == false;
        hold(is_there, || format!("at column {column} the cursor is drawn as {cross}"))?;
    }
    page.browser.value("canvas.blur()")?;
    let cross = differs(page)?;
    hold(cross[0] == 0, || format!("without keys the cursor is drawn as {cross}"))
}

/// A finger that taps the picture's middle is told what is there.
fn a_tap_tells_its_pixel(page: &mut LivePage) -> Outcome {
    page.browser.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": true }))?;
    let middle = page.browser.value(
        "(() => { byId('picture').scrollIntoView({ block: 'center' }); \
         const box = canvas.getBoundingClientRect(); \
         return [box.left + box.width / 2, box.top + box.height / 2]; })()",
    )?;
    for (kind, points) in
        [("touchStart", json!([{ "x": middle[0], "y": middle[1] }])), ("touchEnd", json!([]))]
    {
        page.browser.call("Input.dispatchTouchEvent", json!({ "type": kind, "touchPoints": points }))?;
    }
    let said = page.text("pixel")?;
    page.browser.call("Emulation.setTouchEmulationEnabled", json!({ "enabled": false }))?;
    // A pixel of the screen may be more than one of the picture.
    let is_near = |word: &str, due: f64| {
        let number = said.split_once(word).and_then(|(_, rest)| rest.split([',', ':']).next()?.parse().ok());
        number.is_some_and(|number: f64| (number - due).abs() <= 2.0)
    };
    hold(is_near("column ", 320.0) && is_near("row ", 240.0), || {
        format!("a tap in the middle leads to '{said}'")
    })
}

/// Where nothing is known of the cameras there are no points, and no keys for them.
pub fn without_depths_it_tells_no_keys_of_points(stereo: &Path, scene: &Path) -> Outcome {
    let out = scene.join("plain");
    let mut run = Command::new(stereo);
    run.args(["match", "--disparities", "64", "--quiet", "--out"]).arg(&out);
    for side in ["left", "right"] {
        run.arg(format!("--{side}")).arg(scene.join(side).with_extension("png"));
    }
    output_of(&mut run)?;
    let mut page = opened(&url_of(&out.join("report.html")))?;
    let (keys, thrown) = (page.text("keys")?, page.thrown());
    let is_right = keys == "Arrow keys move the cursor, with Shift by ten pixels." && thrown.is_empty();
    hold(is_right, || format!("without points '{keys}' is said; {thrown:?}"))
}

/// The disparity, the depth, the confidence and the flags of pixels all over the picture, which may have
/// fewer of them than the files.
pub fn pixels_are_those_of_the_files(page: &mut LivePage, run: &Path) -> Outcome {
    let (map, depth) = (numbers(&run.join("disparity.pfm"))?, numbers(&run.join("depth.pfm"))?);
    let open = |name: &str| {
        let path = run.join(name);
        image::open(&path).map_err(|e| failed(&path, &e))
    };
    let (flags, confidence) = (open("flags.png")?.into_luma8(), open("confidence.png")?.into_luma8());
    let (flags, confidence) = (flags.into_raw(), confidence.into_raw());
    let size = page.browser.value("[state.planes.width, state.planes.height]")?;
    let [width, height] = [0, 1].map(|axis| size[axis].as_u64().unwrap_or(0) as usize);
    let count = width * height;
    let places: Vec<_> = (0..PIXELS).map(|i| (i * count / PIXELS + 37 * i) % count.max(1)).collect();
    let asked: Vec<_> = places.iter().map(|at| [at % width, at / width]).collect();
    let said =
        page.browser.value(&format!("{}.map(([x, y]) => describePixel(state, x, y))", json!(asked)))?;
    let mut without = 0;
    for (&at, said) in places.iter().zip(said.as_array().into_iter().flatten()) {
        let said = said.as_str().unwrap_or_default();
        // The pixel of the files that is in the middle of the page's.
        let in_middle = |at: usize, here: usize, there: usize| (2 * at + 1) * there / (2 * here);
        let (column, row) =
            (in_middle(at % width, width, map.width), in_middle(at / width, height, map.height));
        let at = row * map.width + column;
        let names = PixelFlags::NAMES.iter().filter(|(flag, _)| flags[at] & flag.bits() != 0);
        let names: Vec<_> = names.map(|(_, name)| *name).collect();
        let why = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        let begin = format!("column {column}, row {row}: ");
        let mut parts = vec![begin, format!("flags: {why}")];
        if map.values[at].is_finite() {
            // Half a digit is rounded up.
            parts.push(format!("disparity {:.3} px, sigma ", map.values[at] + 1e-5));
            parts.push(format!("; confidence {} of ", confidence[at]));
            depth_is_told(said, depth.values[at])?;
        } else {
            parts.push("no answer".into());
            without += 1;
        }
        hold(parts.iter().all(|part| said.contains(part.as_str())), || {
            format!("the report says '{said}', the files {parts:?}")
        })?;
    }
    println!("the report says of {PIXELS} pixels what the files say");
    hold(without > 0 && without < PIXELS, || format!("{without} of {PIXELS} pixels have no answer"))
}

/// Whether a depth in metres is said to its digits, or that it is infinite.
fn depth_is_told(said: &str, metres: f32) -> Outcome {
    let words = said.split_once("; depth ").map(|(_, words)| words.split([' ', ',']));
    let told = words.and_then(|mut words| words.next()?.parse::<f32>().ok().zip(words.next()));
    let is_told = match told {
        None => metres.is_infinite() && said.contains("; at infinity; "),
        Some((mm, "mm")) => (mm - 1000.0 * metres).abs() < 0.51,
        Some((far, _)) => metres > 99.9 && (far - metres).abs() < 1e-3 * metres,
    };
    hold(is_told, || format!("the report says '{said}', the depth is {metres} m"))
}

/// At first the share of the answers is that of summary.json; each slider takes answers away and gives them
/// back.
fn sliders_change_what_is_said(page: &mut LivePage, run: &Path) -> Outcome {
    let path = run.join("summary.json");
    let text = fs::read_to_string(&path).map_err(|e| failed(&path, &e))?;
    let summary: Value = serde_json::from_str(&text).map_err(|e| failed(&path, &e))?;
    let all = page.text("figures")?;
    let density = 100.0 * summary["density"].as_f64().unwrap_or(f64::NAN);
    let bad = 100.0 * summary["accuracy"]["bad2"].as_f64().unwrap_or(f64::NAN);
    let line = format!(
        "{density:.2} % of the pixels have an answer that is shown, {bad:.2} % of them over 2 px off where \
         both cameras see."
    );
    hold(all == line, || format!("'{all}' is said, not '{line}'"))?;
    for name in ["least", "near", "far"] {
        let ends = page
            .browser
            .value(&format!("(({{ min, max, value }}) => [min, max, value].map(Number))(byId('{name}'))"))?;
        let [low, high, start] = [0, 1, 2].map(|i| ends[i].as_i64().unwrap_or(-1));
        let label = page.text(&format!("{name}-says"))?;
        page.set(name, (low + high) / 2)?;
        let (fewer, other) = (page.text("figures")?, page.text(&format!("{name}-says"))?);
        let share = |text: &str| text.split(' ').next().and_then(|n| n.parse::<f64>().ok());
        hold(share(&fewer) < share(&all) && other != label, || {
            format!("the slider {name}: '{fewer}' of '{all}', and it says '{other}'")
        })?;
        what_is_hidden_is_no_pixel_without_an_answer(page)?;
        page.set(name, start)?;
        let again = page.text("figures")?;
        hold(again == all, || Failure::new(format!("{name}: '{again}'")).to_string())?;
    }
    Ok(())
}

/// Of answers that the sliders keep back the page says that, and what they are, and paints their flags.
fn what_is_hidden_is_no_pixel_without_an_answer(page: &mut LivePage) -> Outcome {
    page.press("view-flags")?;
    let found = page.browser.value(
        "(() => { const { width, disparity: all } = whole.planes; \
         const words = new Uint32Array(image.data.buffer); \
         const hidden = [...all.keys()].filter((i) => all[i] !== state.planes.disparity[i]); \
         const at = (i) => describePixel(state, i % width, Math.floor(i / width)); \
         return { count: hidden.length, black: hidden.filter((i) => words[i] === BLACK).length, \
         wrong: hidden.filter((_, i) => i % 97 === 0).map(at).filter((said) => \
         !/, hidden by the sliders: disparity [0-9.]+ px, sigma/.test(said)) }; })()",
    )?;
    let is_right = found["count"].as_u64() > Some(0) && found["black"] == 0 && found["wrong"] == json!([]);
    hold(is_right, || format!("of what the sliders keep back: {found}"))?;
    page.press("view-disparity")
}
