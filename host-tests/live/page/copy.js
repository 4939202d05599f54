// The settings in other words: a command line, Rust, C.

const TYPES = ["Fast", "Block", "SgmLean", "Sgm", "SgmEdge"];
const capital = (word) => word[0].toUpperCase() + word.slice(1);
const SWITCHES = ["refuse_flat", "refuse_ceiling", "median", "refuse_repeats"];
const OPTIONS = ["left_right_px", "uniqueness_percent"];
const DISPARITIES = ["surface_step", "fill_step", "fattening_slope"];

// A file's name as one word of a shell.
const quoted = (name) => (/^[\w.,\/+-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`);

// The places of the settings that are not the filter's.
function others(settings, preset) {
  return [...settings.keys()].filter((i) => i >= CHECKS && settings[i] !== preset[i]);
}

function asCommand({ settings, preset, noise, pair, rig, hasDepth }) {
  const value = (name) => settings[at(name)];
  // A frame of a sequence is a file, one of a video or a camera is none.
  const isFrame = pair.isMoving && !Array.isArray(pair.of[0]);
  const files = pair.isOne ? `--side-by-side ${isFrame ? "frame.png" : quoted(pair.left.name)}`
    : isFrame ? "--left left.png --right right.png"
      : `--left ${quoted(pair.left.name)} --right ${quoted(pair.right.name)}`;
  const typed = hasDepth && rig.offset_px === 0
    ? ` --focal-px ${rig.focal_px} --baseline-mm ${rig.baseline_mm}` : "";
  const cameras = calibrationWords() ?? typed;
  const words = [
    `stereo match ${files}`,
    `--disparities ${value("disparities")} --min-disparity ${value("min_disparity")}`,
    `--method ${METHODS[value("method")]} --filter ${FILTERS[value("filter")]} --noise ${noise}`,
    `--min-confidence ${value("min_confidence")} --balance ${isOff("balance") ? "none" : "auto"}`,
    `${cameras.trim()}${cameras ? " " : ""}--out depth`,
  ];
  const frames = pair.isOne ? "# frame.png is a frame of it" : "# left.png, right.png are frames of them";
  const notes = isFrame ? [frames] : [];
  const other = others(settings, preset).map((i) => CONTROLS[i].name);
  if (other.length > 0) notes.push(`# ${other.join(", ")}: no options of match; copy as Rust or C`);
  if (calibration.isTyped && calibrationWords()) {
    notes.push("# depths are those of the calibration, not of the cameras that were typed");
  }
  if (hasDepth && rig.offset_px !== 0 && !calibrationWords()) {
    notes.push("# principal points apart: give --calib FILE for depths");
  }
  return [words.join(" \\\n  "), ...notes].join("\n");
}

// A field's value in Rust.
function inRust(name, value) {
  if (SWITCHES.includes(name)) return value !== 0 ? "true" : "false";
  if (OPTIONS.includes(name)) return value === OFF ? "None" : `Some(${value})`;
  if (DISPARITIES.includes(name)) {
    return value === OFF ? "Disparity::NONE" : `Disparity::from_raw(${value})`;
  }
  return String(value);
}

// Fields as they stand in a literal: those of an array together.
function fields(settings, places) {
  const seen = new Map();
  for (const i of places) {
    const [name, index] = CONTROLS[i].name.split("[");
    if (index === undefined) {
      seen.set(name, inRust(name, settings[i]));
    } else {
      const all = settings.filter((_, k) => CONTROLS[k].name.startsWith(`${name}[`));
      seen.set(name, `[${[...all].join(", ")}]`);
    }
  }
  return [...seen].map(([name, text]) => `${name}: ${text}`);
}

// A field of the configuration that has fields itself, of which these are given.
function given(name, all) {
  if (all.length === 0) return [];
  const lines = all.map((field) => `        ${field},`);
  return [`    ${name}: ${capital(name)} {`, ...lines, `        ..config.${name}`, "    },"];
}

function asRust({ settings, preset, planes }) {
  const value = (name) => settings[at(name)];
  const type = TYPES[value("method")];
  const other = others(settings, preset);
  const checks = fields(settings, other.filter((i) => i < PENALTIES));
  const penalties = fields(settings, other.filter((i) => i >= PENALTIES));
  const more = [...given("checks", checks), ...given("penalties", penalties)];
  const types = ["Config", "Filter", type];
  if (checks.length > 0) types.push("Checks");
  if (penalties.length > 0) types.push("Penalties");
  return [
    "use stereopsis::imaging::Noise;",
    `use stereopsis::matching::{${types.sort().join(", ")}};`,
    ...(checks.join().includes("Disparity::") ? ["use stereopsis::units::Disparity;"] : []),
    "",
    `let config = Config::for_method::<${type}>(${planes.width}, ${planes.height}, ${value("disparities")});`,
    "let config = Config {",
    `    min_disparity: ${value("min_disparity")},`,
    "    confidence: true,",
    `    min_confidence: ${value("min_confidence")},`,
    `    noise: Noise::${capital(NOISES[value("noise")])},`,
    "    ..config",
    "};",
    `let config = config.with_filter::<${type}>(Filter::${capital(FILTERS[value("filter")])});`,
    ...(more.length > 0 ? ["let config = Config {", ...more, "    ..config", "};"] : []),
  ].join("\n");
}

function asC({ settings, preset, planes }) {
  const value = (name) => settings[at(name)];
  const name = FILTERS[value("filter")].toUpperCase();
  const noise = NOISES[value("noise")].toUpperCase();
  const size = `${planes.width}, ${planes.height}, ${value("disparities")}`;
  const inC = (i) => (DISPARITIES.includes(CONTROLS[i].name) && settings[i] === OFF ? 65535 : settings[i]);
  return [
    `/* Linked with a library that is made for the method ${METHODS[value("method")]}. */`,
    "stereopsis_config config;",
    `stereopsis_config_default(${size}, STEREOPSIS_PRESET_${name}, &config);`,
    `stereopsis_config_noise(STEREOPSIS_PRESET_${name}, STEREOPSIS_NOISE_${noise}, &config);`,
    `config.min_disparity = ${value("min_disparity")};`,
    "config.confidence = 1;",
    `config.min_confidence = ${value("min_confidence")};`,
    ...others(settings, preset).map((i) => `config.${CONTROLS[i].name} = ${inC(i)};`),
  ].join("\n");
}
