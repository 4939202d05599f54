// The views of a result, painted pixel by pixel, and what their colours mean.

const NO_ANSWER = 0xffff;
// The steps of a disparity in a px.
const STEPS_PX = 32;
// What is farther has the colour of this, and is no point: few pixels would take the colours of all others.
const FARTHEST_MM = 65535;
const VIEWS = ["left", "right", "disparity", "depth", "flags", "confidence", "points"];

// A colour in the order of a canvas's bytes, read as one little-endian word.
const packed = ([red, green, blue]) => ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
const css = (rgb) => `rgb(${rgb.join(" ")})`;
const greyWord = (value) => packed([value, value, value]);
const BLACK = packed([0, 0, 0]);

// 256 colours between those of the data: far is dark, near is bright.
const RAMP = Array.from({ length: 256 }, (_, step) => {
  const { ramp } = DATA;
  const at = (step / 255) * (ramp.length - 1);
  const low = Math.min(Math.floor(at), ramp.length - 2);
  return [0, 1, 2].map((c) => Math.round(ramp[low][c] + (at - low) * (ramp[low + 1][c] - ramp[low][c])));
});
const RAMP_WORDS = Uint32Array.from(RAMP, packed);

// How often each number occurs, and the colour of each, of those that are painted.
const counts = new Uint32Array(65536);
const colourOf = new Uint32Array(65536);

// The numbers between which the colours run: the 2nd to the 98th of a hundred of those that are some.
function ends(numbers, none) {
  counts.fill(0);
  for (let i = 0; i < numbers.length; i += 1) counts[numbers[i]] += 1;
  const all = numbers.length - counts[none];
  if (all === 0) return null;
  counts[none] = 0;
  const quantile = (share) => {
    let left = Math.round(share * (all - 1)) - counts[0];
    let number = 0;
    while (left >= 0) {
      number += 1;
      left -= counts[number];
    }
    return number;
  };
  return [quantile(0.02), quantile(0.98)];
}

// Paints numbers in the colours of the ramp; `isNear` says whether large ones are near.
function paintNumbers(words, numbers, none, isNear) {
  const found = ends(numbers, none);
  if (!found) {
    words.fill(BLACK);
    return null;
  }
  const [low, high] = found;
  const scale = 255 / Math.max(high - low, 1);
  const colour = (number) => {
    const step = Math.round((number - low) * scale);
    return RAMP_WORDS[isNear ? step : 255 - step];
  };
  colourOf.fill(colour(low), 0, low);
  for (let number = low; number <= high; number += 1) colourOf[number] = colour(number);
  colourOf.fill(colour(high), high + 1);
  colourOf[none] = BLACK;
  for (let i = 0; i < words.length; i += 1) words[i] = colourOf[numbers[i]];
  return found;
}

// The depth of a disparity in steps, m: Z = f b / (d + doffs), infinite at infinity and behind.
function depthOf(steps, { focal_px: focal, baseline_mm: baseline, offset_px: offset }) {
  const shift = steps / STEPS_PX + offset;
  return shift > 0 ? (focal * baseline) / shift / 1000 : Infinity;
}

// The depth in whole mm whose colour a depth has; 0 is none.
const paintedMm = (metres) => Math.min(Math.max(Math.round(1000 * metres), 1), FARTHEST_MM);

// A length with so many digits of a mm, beyond 100 m in metres.
function lengthWords(mm, digits) {
  return mm < 1e5 ? `${mm.toFixed(digits)} mm` : `${(mm / 1000).toFixed(mm < 1e6 ? 1 : 0)} m`;
}

// The first reason without an answer, or that it was filled in, as a place in the flags' list; -1 for a pixel
// with an answer of its own.
function reason(answered, flags) {
  return DATA.flags.findIndex(({ bit, name }) => (flags & bit) !== 0 && (!answered || name === "filled"));
}

// Paints a picture as it was opened.
function paintPicture(words, { pixels }) {
  words.set(new Uint32Array(pixels.buffer, pixels.byteOffset, words.length));
}

// What is said where there is nothing to paint: cameras are a part of the live page alone.
const NO_CAMERAS = "No depth: give focal length and baseline under Cameras.";
const NO_DISTANCE = "No answer that is shown has a distance.";
const NO_ANSWERS = "No pixel has an answer that is shown.";

// Paints one of the views into words, one for each pixel; elements that say what the colours mean.
const PAINT = {
  left: (words, { pair }) => (paintPicture(words, pair.left), ["The left picture: answers belong to it."]),
  right: (words, { pair }) => (paintPicture(words, pair.right), ["The right picture."]),
  disparity: (words, { planes }) => {
    const found = paintNumbers(words, planes.disparity, NO_ANSWER, true);
    if (!found) return [NO_ANSWERS];
    return rampLegend(found.map((raw) => `${(raw / STEPS_PX).toFixed(1)} px`));
  },
  depth: (words, { planes, hasDepth, rig }) => {
    if (!hasDepth) {
      words.fill(BLACK);
      return [NO_CAMERAS];
    }
    // A disparity has one depth, so that there are fewer of them than of pixels.
    const depths = Uint16Array.from({ length: NO_ANSWER }, (_, steps) => paintedMm(depthOf(steps, rig)));
    const found = paintNumbers(words, planes.disparity.map((steps) => depths[steps] ?? 0), 0, false);
    if (!found) return [NO_DISTANCE];
    const [near, far] = found.map((mm) => `${(mm / 1000).toFixed(2)} m`);
    return rampLegend([counts[FARTHEST_MM] > 0 ? `${far} and beyond` : far, near]);
  },
  // Of the whole result: a pixel that is kept back has its answer, and no reason for having none.
  flags: (words, { planes, whole }) => {
    const { disparity, flags, left } = whole ?? planes;
    const colours = DATA.flags.map(({ colour }) => packed(colour));
    for (let i = 0; i < words.length; i += 1) {
      const place = reason(disparity[i] !== NO_ANSWER, flags[i]);
      const pale = disparity[i] === NO_ANSWER ? BLACK : greyWord(160 + (left[i] >> 2));
      words[i] = place < 0 ? pale : colours[place];
    }
    return ["Pale: an answer. ", ...DATA.flags.map(({ name, colour }) => swatch(colour, name))];
  },
  confidence: (words, { planes }) => {
    for (let i = 0; i < words.length; i += 1) {
      const step = Math.round((255 * planes.confidence[i]) / DATA.most_confidence);
      words[i] = planes.confidence[i] === 0 ? BLACK : RAMP_WORDS[Math.min(step, 255)];
    }
    return rampLegend(["1", String(DATA.most_confidence)]);
  },
};

function rampLegend([dark, bright]) {
  const stops = RAMP.filter((_, step) => step % 51 === 0).map(css).join(", ");
  const ramp = make("span", { class: "ramp", style: `background: linear-gradient(to right, ${stops})` });
  return [dark, ramp, `${bright}; black: no answer${state.whole ? " that is shown" : ""}`];
}

// A colour and what it means.
function swatch(colour, name) {
  const key = make("span", { class: "key" });
  key.append(make("span", { class: "swatch", style: `background: ${css(colour)}` }), name);
  return key;
}

// How many columns and rows of the pair a pixel of the page's picture stands for. A picture that was made
// smaller has whole rows, so that they are not as much fewer as the columns.
const ratioTo = ({ width, height }) => [DATA.columns / width, DATA.rows / height];

// The column or the row of the pair that a pixel of the page's picture was taken from, in the numbers of 32
// bits in which that was done.
const takenFrom = (at, ratio) => Math.floor(Math.fround((at + 0.5) * Math.fround(ratio)));

// Where a pixel of the page's picture is in the pair, and whether its answer is kept back.
function placeWords({ planes, whole, ratio }, x, y) {
  const [column, row] = [x, y].map((at, axis) => takenFrom(at, ratio[axis]));
  const pixel = y * planes.width + x;
  const isHidden = whole && whole.disparity[pixel] !== planes.disparity[pixel];
  return `column ${column}, row ${row}${isHidden ? ", hidden by the sliders" : ""}: `;
}

// What is known of a pixel, in one line.
function describePixel(state, x, y) {
  const { hasDepth, rig } = state;
  const planes = state.whole ?? state.planes;
  const pixel = y * planes.width + x;
  const raw = planes.disparity[pixel];
  const flags = DATA.flags.filter(({ bit }) => (planes.flags[pixel] & bit) !== 0).map(({ name }) => name);
  const why = flags.length > 0 ? flags.join(", ") : "none";
  const place = placeWords(state, x, y);
  if (raw === NO_ANSWER) return `${place}no answer; flags: ${why}`;
  const sigmaPx = planes.sigma[pixel];
  let text = `${place}disparity ${(raw / STEPS_PX).toFixed(3)} px, sigma ${sigmaPx.toFixed(2)} px`;
  const mm = hasDepth ? 1000 * depthOf(raw, rig) : 0;
  if (mm === Infinity) {
    text += "; at infinity";
  } else if (mm > 0) {
    const sigmaMm = ((mm * mm) / (rig.focal_px * rig.baseline_mm)) * sigmaPx;
    text += `; depth ${lengthWords(mm, 0)}, sigma ${lengthWords(sigmaMm, sigmaMm < 10 ? 1 : 0)}`;
  }
  // An answer's is never 0: then it was not asked for.
  const sure = planes.confidence[pixel];
  const confidence = sure > 0 ? `; confidence ${sure} of ${DATA.most_confidence}` : "";
  return `${text}${confidence}; flags: ${why}`;
}
