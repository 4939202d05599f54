// Elements of a page, and controls that say what they stand at.

const byId = (id) => document.getElementById(id);

// An element with attributes.
function make(tag, attributes = {}, text = "") {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.textContent = text;
  return element;
}

// A control of the page, which calls `changed` when it is moved.
function addControl(parent, control, changed) {
  const row = make("div", { class: "control" });
  const label = make("label", { for: control.name }, control.label);
  let input;
  if (control.words) {
    input = make("select", { id: control.name });
    control.words.forEach((word, place) => input.append(make("option", { value: place }, word)));
  } else if (control.say) {
    const { min, max, step = 1 } = control;
    input = make("input", { type: "range", id: control.name, min, max, step });
    control.output = make("output", { for: control.name, id: `${control.name}-says` });
  } else if (control.step) {
    input = make("input", { type: "number", id: control.name, step: control.step });
  } else {
    input = make("input", { type: "checkbox", id: control.name });
  }
  row.append(label, ...(control.output ? [control.output, input] : [input]));
  parent.append(row);
  control.input = input;
  control.row = row;
  input.addEventListener("input", () => {
    say(control);
    changed(control);
  });
}

// Writes what a control stands at beside it, and for screen readers in place of the bare number.
function say(control) {
  if (!control.output) return;
  const text = control.say(valueOf(control));
  control.output.textContent = text;
  control.input.setAttribute("aria-valuetext", text);
}

function valueOf({ input }) {
  return input.type === "checkbox" ? Number(input.checked) : Number(input.value);
}

function setValue(control, value) {
  if (control.input.type === "checkbox") control.input.checked = value !== 0;
  else control.input.value = value;
  say(control);
}
