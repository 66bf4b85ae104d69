// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// The viewer's place in the page: which results, which layers, which colours, and what was clicked on.
import { gradient, sequential } from "../colors.js";
import { button, choice, el, rough } from "../dom.js";
import { isShown, nameOf, onFilter } from "../filter.js";
import { hasFrame, openFrame } from "../frames.js";
import { highOf, layersOf, leftOut, places } from "./layers.js";
import { shared } from "./materials.js";
import { View } from "./view.js";

const hex = (color) => `#${color.toString(16).padStart(6, "0")}`;

class Panel {
  constructor(place) {
    const named = places.map((group, i) => [i, nameOf(group) || "all"]);
    this.left = choice("result", named, () => this.load());
    this.right = choice("beside it", [["", "nothing"], ...named], () => this.load());
    this.canvas = el("canvas", { tabindex: 0, role: "img", "aria-label":
      "Geometry in three dimensions. Arrow keys turn, plus and minus zoom.", click: (event) => this.click(event),
      pointerdown: (event) => { this.pressed = [event.clientX, event.clientY]; } });
    this.labels = el("div", { class: "pane-labels", "aria-hidden": true });
    this.toggles = el("fieldset", { class: "layers" });
    this.told = el("p", { class: "readout", "aria-live": "polite" }, "Click on a point, a face or a camera.");
    const size = el("input", { type: "range", min: 1, max: 10, step: 0.5, value: 3, input: () => {
      shared.pointSize.value = Number(size.value) * Math.min(devicePixelRatio, 2);
      this.view.redraw();
    } });
    place.append(
      el("div", { class: "controls" }, this.left.element, this.right.element,
        ...[["Fit", [-0.7, -1, 0.55]], ["Above", [0, -0.001, 1]], ["Side", [0, -1, 0.05]]].map(([text, direction]) =>
          button(text, () => this.view.look(this.low, this.high, direction)))),
      el("div", { class: "stage" }, this.canvas, this.labels), this.told, this.scale(),
      el("div", { class: "controls" }, this.toggles, el("label", { class: "choice" }, el("span", {}, "point size"), size)));
    place.append(...[...new Set(leftOut)].map((text) => el("p", { class: "note" }, text)));
    this.view = new View(this.canvas);
    shared.pointSize.value = 3 * Math.min(devicePixelRatio, 2);
    this.left.element.hidden = this.right.element.hidden = places.length === 1;
    if (places.length > 1) onFilter(() => this.followFilter());
    this.load();
  }

  scale() {
    const bar = el("div", { class: "bar" });
    bar.style.background = gradient(sequential);
    const field = (label) => el("input", { type: "number", step: "any", "aria-label": label, change: () => {
      shared.range.value.set(Number(this.from.value), Number(this.to.value));
      this.view.redraw();
    } });
    this.from = field("first colour at");
    this.to = field("last colour at");
    this.unit = el("span", {});
    this.bar = el("div", { class: "scale range" }, this.from, bar, this.to, this.unit);
    return this.bar;
  }

  followFilter() {
    if (isShown(places[Number(this.left.select.value)])) return;
    const at = places.findIndex((group) => isShown(group));
    if (at < 0) return;
    this.left.select.value = at;
    this.load();
  }

  async load() {
    const wanted = [this.left.select.value, this.right.select.value].filter((value) => value !== "").map(Number);
    const first = await layersOf(places[wanted[0]]);
    const loaded = [first];
    for (const i of wanted.slice(1)) loaded.push(await layersOf(places[i], first.centre));
    this.panes = loaded;
    this.labels.replaceChildren(...wanted.map((i) => el("span", {}, nameOf(places[i]))));
    [this.low, this.high] = [first.low, first.high];
    this.view.setPanes(loaded);
    this.view.look(first.low, first.high);
    this.list();
    this.setRange();
    this.canvas.dataset.ready = String(loaded.length);
  }

  /// Layers of one title are switched in both panes at once.
  list() {
    const titles = [...new Set(this.panes.flatMap(({ layers }) => layers.map((layer) => layer.title)))];
    this.toggles.replaceChildren(el("legend", {}, "shown"), ...titles.map((title) => this.toggle(title)));
  }

  toggle(title) {
    const layers = this.panes.flatMap((pane) => pane.layers.filter((layer) => layer.title === title));
    const box = el("input", { type: "checkbox", checked: layers[0].isOn, change: () => {
      for (const layer of layers) layer.isOn = box.checked;
      this.setRange();
    } });
    const counts = [...new Set(layers.map((layer) => layer.count))].join(" | ");
    const legend = (layers[0].legend ?? []).map(([text, color]) => {
      const dot = el("i", {});
      dot.style.background = hex(color);
      return el("span", { class: "key" }, dot, text);
    });
    const row = el("div", { class: "layer" }, el("label", {}, box, el("span", {}, title)), el("small", {}, counts), ...legend);
    if (layers[0].colorings.length) row.append(this.coloring(layers));
    return row;
  }

  coloring(layers) {
    const labels = layers[0].colorings.map((coloring) => coloring.label);
    const select = choice("coloured by", [["", "nothing"], ...labels.map((label) => [label, label])], (label) => {
      for (const layer of layers) layer.colorBy(layer.colorings.find((coloring) => coloring.label === label));
      this.setRange();
    });
    select.select.value = layers[0].coloring?.label ?? "";
    return select.element;
  }

  /// Colours from 0 to what 95 % of the values in sight do not exceed, the same in both panes.
  setRange() {
    const colorings = this.panes.flatMap(({ layers }) => layers.filter((l) => l.isOn && l.coloring).map((l) => l.coloring));
    const high = Math.max(0, ...colorings.map(highOf));
    this.bar.hidden = colorings.length === 0;
    shared.range.value.set(0, high || 1);
    this.from.value = 0;
    this.to.value = rough(high || 1);
    this.unit.textContent = colorings[0] ? `${colorings[0].unit ?? ""} (5 % of the values are beyond)` : "";
    this.view.redraw();
  }

  click(event) {
    const [x, y] = this.pressed ?? [event.clientX, event.clientY];
    if (Math.hypot(event.clientX - x, event.clientY - y) > 4) return;
    const box = this.canvas.getBoundingClientRect();
    const found = this.view.pick(event.clientX - box.left, event.clientY - box.top);
    if (!found) return;
    const side = this.panes.length > 1 ? `${this.labels.children[found.pane].textContent}: ` : "";
    this.told.replaceChildren(side + found.layer.tell(found.index));
    const frame = found.layer.frame?.(found.index);
    const group = places[Number([this.left, this.right][found.pane].select.value)];
    if (frame && hasFrame(group)) this.told.append(" ", button("Show its frame", () => this.open(group, frame)));
  }

  async open(group, frame) {
    const isThere = await openFrame(group, frame) || await openFrame(group, frame.replace(/\.[^.]*$/, ""));
    if (!isThere) this.told.append(" This result has no depth map of it.");
  }
}

export function mountViewer() {
  const place = document.getElementById("viewer");
  if (!place || places.length === 0) return null;
  try {
    return new Panel(place).view;
  } catch (error) {
    place.replaceChildren(el("p", { class: "warning" }, `This browser shows no 3-D: ${error.message}`));
    return null;
  }
}
