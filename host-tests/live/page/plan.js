// A rig before it is built: what `stereo plan` says of these fields, by the same code.

const LENSES = ["focal length, px", "focal length, mm", "field of view, degrees"];
const PLAN = [
  { name: "plan-baseline", label: "Baseline, mm", step: "any", start: 60, option: "baseline-mm" },
  { name: "plan-lens-kind", label: "The lens is given as", words: LENSES, start: 0 },
  { name: "plan-lens", label: "Lens", step: "any", start: 420 },
  { name: "plan-sensor", label: "Sensor's width, mm (for mm)", step: "any", start: "" },
  { name: "plan-columns", label: "Columns of the images", step: 1, start: 320 },
  { name: "plan-rows", label: "Rows", step: 1, start: 240 },
  { name: "plan-nearest", label: "Nearest depth, m", step: "any", start: 0.4, option: "nearest" },
  { name: "plan-farthest", label: "Farthest depth, m", step: "any", start: 5, option: "farthest" },
  { name: "plan-accuracy", label: "Deviation there, %", step: "any", start: 5, option: "accuracy" },
  { name: "plan-rate", label: "Frames a second, if wanted", step: "any", start: "", option: "frame-rate" },
  { name: "plan-ram", label: "RAM, KB, if limited", step: "any", start: "", option: "ram-kb" },
  { name: "plan-core", label: "Core", words: ["all", ...DATA.cores.map(([core]) => core)], start: 0 },
  { name: "plan-clock", label: "Clock, MHz, if another", step: "any", start: "", option: "clock-mhz" },
  { name: "plan-method", label: "Method", words: ["all", ...METHODS], start: 0 },
];

// What a field says; nothing where it is empty.
function planned(name) {
  const { input } = PLAN.find((control) => control.name === name);
  return input.value === "" ? undefined : Number(input.value);
}

// The focal length, px.
function planFocal(columns) {
  const lens = planned("plan-lens");
  const sensor = planned("plan-sensor");
  const focal = [
    () => lens,
    () => (lens / sensor) * columns,
    () => columns / 2 / Math.tan((lens * (Math.PI / 180)) / 2),
  ];
  return focal[planned("plan-lens-kind")]();
}

const planWord = (name, words) => (planned(name) > 0 ? words[planned(name) - 1] : undefined);

// The same as a command line.
function planCommand() {
  const lens = ["focal-px", "focal-mm", "field-of-view"][planned("plan-lens-kind")];
  const options = PLAN.filter(({ name, option }) => option && planned(name) !== undefined);
  const core = planWord("plan-core", DATA.cores.map(([name]) => name));
  const method = planWord("plan-method", METHODS);
  return ["stereo plan", ...options.map(({ name, option }) => `--${option} ${planned(name)}`),
    `--${lens} ${planned("plan-lens")}`,
    ...(lens === "focal-mm" ? [`--sensor-width-mm ${planned("plan-sensor")}`] : []),
    `--size ${planned("plan-columns")}x${planned("plan-rows")}`,
    ...(core ? [`--core ${core}`] : []), ...(method ? [`--method ${method}`] : [])].join(" ");
}

let plan = null;

// Says what a rig of these fields tells, takes and lacks.
function tellPlan() {
  if (!state.core) return;
  const columns = planned("plan-columns");
  const asked = {
    baseline_mm: planned("plan-baseline"), focal_px: planFocal(columns), columns, rows: planned("plan-rows"),
    nearest_m: planned("plan-nearest"), farthest_m: planned("plan-farthest"),
    accuracy_percent: planned("plan-accuracy"), frame_rate: planned("plan-rate"), ram_kb: planned("plan-ram"),
    clock_mhz: planned("plan-clock"), core: planWord("plan-core", DATA.cores.map(([name]) => name)),
    method: planWord("plan-method", METHODS),
  };
  try {
    const lacks = [["baseline_mm", "a baseline"], ["focal_px", "a lens"], ["columns", "the images' columns"],
      ["rows", "the images' rows"], ["nearest_m", "a nearest depth"], ["farthest_m", "a farthest depth"],
      ["accuracy_percent", "a deviation"]].find(([name]) => !Number.isFinite(asked[name]));
    if (lacks) throw new Error(`The plan needs ${lacks[1]}.`);
    plan = state.core.plan(asked);
    byId("plan-says").textContent = plan.text;
    byId("plan-command").textContent = planCommand();
    byId("plan-fault").textContent = "";
  } catch (error) {
    plan = null;
    byId("plan-says").textContent = "";
    byId("plan-command").textContent = "";
    byId("plan-fault").textContent = error.message;
  }
  byId("plan-take").disabled = plan === null;
}

// Searches as the plan does.
function takePlan() {
  setValue(CONTROLS[at("disparities")], plan.disparities);
  setValue(CONTROLS[at("min_disparity")], plan.min_disparity);
  later();
}

function addPlan() {
  for (const control of PLAN) {
    addControl(byId("plan-fields"), control, tellPlan);
    setValue(control, control.start);
  }
  byId("plan-take").addEventListener("click", takePlan);
}
