// The picture of a page: one of the views of a result, its cursor, and the hands and keys that move them.

// What is shown, and the whole result where sliders keep back a part of it. A pixel stands for `ratio` pixels
// of a row of the pair, and for so many of a column.
const state = { pair: null, planes: null, whole: null, rig: {}, hasDepth: false, ratio: [1, 1],
  describe: describePixel, depthAt: ({ planes, rig }, i) => depthOf(planes.disparity[i], rig) };
const canvas = byId("picture");
const cloud = new Cloud(canvas);
const context = canvas.getContext("2d");
const cursor = { x: 0, y: 0 };
let image = null;
let isTurning = false;
let isPointed = false;
let isDrawing = false;

const view = () => document.querySelector("input[name=view]:checked").value;

// A button for each view, of which one is shown first. Without the points their keys are not told of.
function addViews(names, first = "disparity") {
  if (!names.includes("points")) byId("point-keys").remove();
  names.forEach((name) => {
    const label = make("label");
    const id = `view-${name.replaceAll(" ", "-")}`;
    const radio = make("input", { type: "radio", name: "view", value: name, id });
    radio.checked = name === first;
    radio.addEventListener("change", show);
    label.append(radio, ` ${name}`);
    byId("views").append(label);
  });
}

// Makes room for pictures of a size.
function fitPicture(width, height) {
  [canvas.width, canvas.height] = [width, height];
  image = context.createImageData(width, height);
  [cursor.x, cursor.y] = [width >> 1, height >> 1];
}

// Shows nothing, until there is room for pictures again.
function forgetPicture() {
  image = null;
  context.clearRect(0, 0, canvas.width, canvas.height);
  byId("legend").replaceChildren();
}

// Paints the view that is chosen.
function show() {
  if (!image) return;
  const isCloud = view() === "points";
  canvas.classList.toggle("points", isCloud);
  let legend;
  if (isCloud) {
    cloud.take(state);
    legend = [cloudWords(cloud.draw(context))];
  } else {
    legend = PAINT[view()](new Uint32Array(image.data.buffer), state);
    putPicture();
  }
  cloud.isOn = isCloud;
  byId("legend").replaceChildren(...legend);
  canvas.setAttribute("aria-label", viewWords());
}

// The name of what is shown, for those who do not see it.
function viewWords() {
  const shown = view();
  const { left, right = left } = state.pair;
  if (["left", "right"].includes(shown)) return `${shown} picture, ${state.pair[shown].name}`;
  return `${shown} of ${[...new Set([left.name, right.name])].join(" and ")}`;
}

// The picture as it was painted last, and on it the cursor while keys move it.
function putPicture() {
  context.putImageData(image, 0, 0);
  if (document.activeElement !== canvas) return;
  // As large on the screen whatever the picture's size, but no thinner than a pixel of it.
  const unit = Math.max(canvas.width / canvas.clientWidth, 1);
  const [x, y] = [cursor.x + 0.5, cursor.y + 0.5];
  context.beginPath();
  // The pixel itself stays free.
  for (const [across, down] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
    context.moveTo(x + 3 * unit * across, y + 3 * unit * down);
    context.lineTo(x + 12 * unit * across, y + 12 * unit * down);
  }
  // White on black is seen on every colour.
  for (const [colour, width] of [["black", 3], ["white", 1]]) {
    [context.strokeStyle, context.lineWidth] = [colour, width * unit];
    context.stroke();
  }
}

// What is said below so many points.
function cloudWords(count) {
  if (count === null) return "This browser has no WebGL, which the view of points takes.";
  const farthest = `beyond ${FARTHEST_MM / 1000} m`;
  if (count === 0 && cloud.beyond > 0) return `No points: all answers that are shown are ${farthest}.`;
  if (count === 0) return state.hasDepth ? NO_DISTANCE : NO_CAMERAS;
  const beyond = cloud.beyond > 0 ? `, without ${cloud.beyond} ${farthest}` : "";
  return `${count} points${beyond}; drag to turn, with the right button to move, turn the wheel to come `
    + "nearer.";
}

// The pixel under the pointer.
function moveTo(event) {
  const box = canvas.getBoundingClientRect();
  const inside = (value, most) => Math.min(Math.max(Math.floor(value), 0), most - 1);
  cursor.x = inside(((event.clientX - box.left) / box.width) * canvas.width, canvas.width);
  cursor.y = inside(((event.clientY - box.top) / box.height) * canvas.height, canvas.height);
  seeCursor();
}

// Whether somebody looks at a pixel now.
const isWatched = () => canvas.matches(":hover, :focus");

function tellPixel() {
  isPointed = true;
  if (state.planes) byId("pixel").textContent = state.describe(state, cursor.x, cursor.y);
}

function drawCursor() {
  if (image && view() !== "points") putPicture();
}

// The cursor was moved.
function seeCursor() {
  drawCursor();
  tellPixel();
}

// Turns on and on, until it is stopped.
function keepTurning() {
  if (!isTurning || view() !== "points") return;
  cloud.move([-0.02, 0], 1);
  show();
  requestAnimationFrame(keepTurning);
}

function keyInCloud(key) {
  const turns = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
  const factors = { "+": 1.2, "=": 1.2, "-": 1 / 1.2 };
  if (key === " ") {
    isTurning = !isTurning;
    keepTurning();
    return true;
  }
  if (!turns[key] && !factors[key]) return false;
  cloud.move(turns[key] ?? [0, 0], factors[key] ?? 1);
  show();
  return true;
}

function keyInPicture(key, isFar) {
  const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  if (!moves[key]) return false;
  const [x, y] = moves[key].map((step) => (isFar ? 10 : 1) * step);
  cursor.x = Math.min(Math.max(cursor.x + x, 0), canvas.width - 1);
  cursor.y = Math.min(Math.max(cursor.y + y, 0), canvas.height - 1);
  seeCursor();
  return true;
}

function listenToPicture() {
  // A finger that taps does not move.
  for (const kind of ["pointermove", "pointerdown"]) {
    canvas.addEventListener(kind, (event) => view() !== "points" && moveTo(event));
  }
  // The library turns the points; it is drawn once for all that happens before the next picture.
  const seen = ({ type, buttons }) => {
    if (view() !== "points" || isDrawing || (type === "mousemove" && buttons === 0)) return;
    isDrawing = true;
    requestAnimationFrame(() => {
      isDrawing = false;
      show();
    });
  };
  for (const kind of ["mousemove", "wheel", "touchmove"]) {
    (kind === "mousemove" ? window : canvas).addEventListener(kind, seen, { passive: true });
  }
  for (const kind of ["focus", "blur"]) canvas.addEventListener(kind, drawCursor);
  canvas.addEventListener("keydown", (event) => {
    if (!state.planes || event.ctrlKey || event.altKey || event.metaKey) return;
    const isCloud = view() === "points";
    if (isCloud ? keyInCloud(event.key) : keyInPicture(event.key, event.shiftKey)) event.preventDefault();
  });
}
