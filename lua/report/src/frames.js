// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// A frame of a result: estimate, truth and relative error side by side, with the values under the pointer.
import { diverging, gradient, sequential } from "./colors.js";
import { numbers, report } from "./data.js";
import { button, choice, el, rough, short } from "./dom.js";
import { isPartOf, isShown, nameOf, onFilter } from "./filter.js";

const none = 255;
const last = 254;
const frames = report.views.filter((view) => view.kind === "frame");
const groups = [...new Map(frames.map((frame) => [nameOf(frame.group), frame.group])).values()];

export const framesOf = (group) => frames.filter((frame) => isPartOf(group, frame.group));
export const hasFrame = (group) => framesOf(group).length > 0;

const depthOf = (frame, step) =>
  step === none ? NaN : frame.near * (frame.far / frame.near) ** (step / last);
const errorOf = (frame, step) => (step === none ? NaN : ((2 * step) / last - 1) * frame.largest);

function paint(canvas, frame, steps, table) {
  canvas.width = frame.width;
  canvas.height = frame.height;
  const context = canvas.getContext("2d");
  const image = context.createImageData(frame.width, frame.height);
  steps.forEach((step, i) => {
    const x = i % frame.width, y = Math.floor(i / frame.width);
    const hatch = (x + y) % 6 < 3 ? [120, 120, 120] : [95, 95, 95];
    const color = step === none ? hatch : table[Math.round((step * 255) / last)];
    image.data.set([...color, 255], 4 * i);
  });
  context.putImageData(image, 0, 0);
}

function scale(table, texts) {
  const bar = el("div", { class: "bar" });
  bar.style.background = gradient(table);
  return el("div", { class: "scale" }, bar, el("div", { class: "scale-texts" }, ...texts.map((t) => el("span", {}, t))));
}

const panels = [
  ["estimate", "Estimate", sequential], ["reference", "Truth", sequential], ["error", "Relative error", diverging],
];

class Triptych {
  constructor(place) {
    this.index = 0;
    this.result = choice("result", groups.map((group, i) => [i, nameOf(group) || "all"]), () => this.choose());
    this.result.element.hidden = groups.length === 1;
    this.slider = el("input", { type: "range", min: 0, value: 0, "aria-label": "frame", input: () => {
      this.index = Number(this.slider.value);
      this.draw();
    } });
    this.title = el("output", { class: "frame-name" });
    this.readout = el("p", { class: "readout", "aria-live": "polite" });
    this.canvases = panels.map(([, label]) => el("canvas", { role: "img", "aria-label": label,
      pointermove: (event) => this.read(event), pointerleave: () => this.tell() }));
    this.scales = panels.map(() => el("div"));
    place.append(
      el("div", { class: "controls" }, this.result.element, button("◀", () => this.step(-1), { "aria-label": "previous frame" }),
        this.slider, button("▶", () => this.step(1), { "aria-label": "next frame" }), this.title),
      el("div", { class: "panels" }, ...panels.map(([, label], i) =>
        el("figure", {}, el("figcaption", {}, label), this.canvases[i], this.scales[i]))), this.readout);
    place.addEventListener("keydown", (event) => {
      if (event.target === this.slider) return;
      if (event.key === "ArrowLeft") this.step(-1);
      if (event.key === "ArrowRight") this.step(1);
    });
    this.choose();
  }

  choose() {
    this.list = framesOf(groups[Number(this.result.select.value)]);
    this.slider.max = this.list.length - 1;
    this.index = Math.min(this.index, this.list.length - 1);
    this.draw();
  }

  step(by) {
    this.index = (this.index + by + this.list.length) % this.list.length;
    this.draw();
  }

  async open(group, name) {
    const at = groups.findIndex((g) => isPartOf(group, g) && framesOf(g).some((frame) => frame.name === name));
    if (at < 0) return false;
    this.result.select.value = at;
    this.list = framesOf(groups[at]);
    this.index = this.list.findIndex((frame) => frame.name === name);
    this.slider.max = this.list.length - 1;
    await this.draw();
    return true;
  }

  async draw() {
    const frame = this.list[this.index];
    this.slider.value = this.index;
    this.title.textContent = `${frame.name} (${this.index + 1} of ${this.list.length})`;
    const steps = await Promise.all(panels.map(([field]) => numbers(frame[field], Uint8Array)));
    if (this.list[this.index] !== frame) return;
    [this.frame, this.steps] = [frame, steps];
    panels.forEach(([, , table], i) => paint(this.canvases[i], frame, steps[i], table));
    const percent = `${rough(100 * frame.largest)} %`;
    const depths = [`${rough(frame.near)} m`, "log", `${rough(frame.far)} m`];
    const texts = [depths, depths, [`−${percent}, too near`, "0", `+${percent}, too far`]];
    this.scales.forEach((place, i) => place.replaceChildren(scale(panels[i][2], texts[i])));
    this.tell();
  }

  tell() {
    const numbersOf = Object.entries(this.frame.errors ?? {}).map(([name, value]) => `${name} ${short(value)}`);
    this.readout.textContent = [...numbersOf, "Grey is no value. Point at a pixel to read it."].join(", ");
  }

  read(event) {
    const box = event.target.getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * this.frame.width);
    const y = Math.floor(((event.clientY - box.top) / box.height) * this.frame.height);
    const at = y * this.frame.width + x;
    if (!(at >= 0 && at < this.steps[0].length)) return;
    const [estimate, truth, error] = this.steps.map((steps) => steps[at]);
    this.readout.textContent = `estimate ${short(depthOf(this.frame, estimate))} m, truth ${
      short(depthOf(this.frame, truth))} m, error ${short(100 * errorOf(this.frame, error))} %`;
  }
}

let triptych = null;

/// Shows a frame of the first result that has it and belongs to the group. Returns whether there is one.
export async function openFrame(group, name) {
  if (!triptych || !(await triptych.open(group, name))) return false;
  const section = document.getElementById("frames");
  section.scrollIntoView({ behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
  triptych.slider.focus({ preventScroll: true });
  return true;
}

export function mountFrames() {
  const place = document.getElementById("triptych");
  if (!place || frames.length === 0) return;
  triptych = new Triptych(place);
  onFilter(() => {
    const at = groups.findIndex((group) => isShown(group));
    const current = groups[Number(triptych.result.select.value)];
    if (at < 0 || isShown(current)) return;
    triptych.result.select.value = at;
    triptych.choose();
  });
}
