// Runs the script of an animation page without a browser: a document that remembers, a canvas that records its lines.
// Input on stdin: {"script", "data"}, and
//   "presses": [id, or null for the document; event; its fields],
//   "traces": numbers of the traces that are asked for,
//   "plays", "loops": whether it plays by itself, and again,
//   "clocks": ms, at which pictures are asked for,
//   "times": s, whose frames are asked for.
// Output: what the geometry gives, and the lines of the last picture.
"use strict";

const input = JSON.parse(require("fs").readFileSync(0, "utf8"));
const elements = {};
let lines = [], path = [], waiting = [], texts = [];

function element(tagName) {
  const listeners = {};
  return {
    tagName, listeners, children: [], attributes: {}, value: "", textContent: "", checked: false,
    clientWidth: 800, clientHeight: 600, width: 0, height: 0,
    addEventListener: (name, listener) => (listeners[name] = listener),
    setAttribute(name, value) { this.attributes[name] = value; },
    append(...parts) {
      this.children.push(...parts);
      for (const part of parts) if (part.selected) this.value = part.value;
    },
    setPointerCapture() {},
    getContext: () => context,
  };
}

const context = {
  setTransform() {}, fillRect() { lines = []; texts = []; }, fill() {}, arc() {},
  beginPath() { path = []; }, moveTo(x, y) { path.push([x, y]); }, lineTo(x, y) { path.push([x, y]); },
  stroke() { lines.push({ color: this.strokeStyle, width: this.lineWidth, points: path }); },
  fillText(words) { texts.push(words); },
};

const document = {
  ...element("DOCUMENT"), documentElement: {}, createElement: (name) => element(name.toUpperCase()),
  getElementById: (id) => (elements[id] ??= element(id.toUpperCase())),
};
document.getElementById("data").textContent = JSON.stringify(input.data);
document.getElementById("loop").checked = Boolean(input.loops);
const window = { ...element("WINDOW"), devicePixelRatio: 2 };
const matchMedia = (query) => ({ matches: query.includes("reduced-motion") && !input.plays, addEventListener() {} });
const getComputedStyle = () => ({ getPropertyValue: (name) => " " + name });
class ResizeObserver {
  observe() {}
}
const requestAnimationFrame = (work) => waiting.push(work);

function settle(clock) {
  const now = waiting;
  waiting = [];
  for (const work of now) work(clock);
}

const names = ["document", "window", "matchMedia", "getComputedStyle", "ResizeObserver", "requestAnimationFrame"];
const geometry = new Function(...names, input.script + "; return { bodyPoints, strokePoints, frameAt, orbited };")(
  document, window, matchMedia, getComputedStyle, ResizeObserver, requestAnimationFrame,
);
for (const [id, name, fields] of input.presses || []) {
  const target = id ? document.getElementById(id) : document;
  Object.assign(target, fields.set || {});
  target.listeners[name]({ target, preventDefault() {}, ...fields });
  settle(0);
}
for (const n of input.traces || []) {
  const box = document.getElementById("traces").children[n].children[0];
  box.checked = true;
  box.listeners.change();
  settle(0);
}
for (const clock of input.clocks || []) settle(clock);

const every = input.data.t.map((_, frame) => frame);
console.log(JSON.stringify({
  points: input.data.bodies.map((_, body) => every.map((frame) => geometry.bodyPoints(input.data, body, frame))),
  strokes: input.data.joints.map((joint) =>
    input.data.glyphs[joint.type].map((stroke) => geometry.strokePoints(input.data, joint, stroke, 0))),
  frames: (input.times || []).map((time) => geometry.frameAt(input.data, time)),
  view: geometry.orbited(input.data.view, input.data.view[1], 0.3, -0.2),
  time: document.getElementById("time").value,
  button: document.getElementById("play").textContent,
  offers: document.getElementById("traces").children.map((label) => label.children[1]),
  lines, texts,
}));
