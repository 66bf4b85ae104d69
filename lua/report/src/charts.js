// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// Charts that answer: values under the pointer, zoom by dragging, a click on a timeline opens the frame.
import uPlot from "uplot";
import { report } from "./data.js";
import { el, short, themed } from "./dom.js";
import { isShown, onFilter } from "./filter.js";
import { hasFrame, openFrame } from "./frames.js";

/// As many colours as the style sheet has lines of.
const nColors = 6;
const dashes = [undefined, [7, 3], [2, 3], [9, 3, 2, 3]];
const charts = [];

const axisLabel = ({ label, unit }) => (label ?? "") + (unit ? ` (${unit})` : "");
const colorOf = (place) => themed(`--line-${(place % nColors) + 1}`);
const dashOf = (place) => dashes[Math.floor(place / nColors) % dashes.length];

function axis(scale, spec, extra = {}) {
  const ink = themed("--ink-soft");
  const grid = themed("--line");
  return { scale, label: axisLabel(spec), stroke: ink, labelSize: 20, labelGap: 0, labelFont: "12px system-ui", font: "11px system-ui",
    grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1 }, ...extra };
}

const scaleOf = (spec) => {
  const hasBounds = spec.low != null && spec.high != null;
  return { time: false, distr: spec.scale === "log" ? 3 : 1, ...(hasBounds ? { range: [spec.low, spec.high] } : {}) };
};

function dataOf(figure) {
  const tables = figure.lines.map((line) => [line.x, line.y]);
  return figure.frames ? [tables[0][0], ...tables.map(([, y]) => y)] : uPlot.join(tables);
}

/// The line that lies nearest to the pointer, by its series' number.
function nearestSeries(plot, index, top) {
  let best = null, least = Infinity;
  plot.series.forEach((series, s) => {
    const y = plot.data[s][index];
    if (s === 0 || !series.show || y == null) return;
    const distance = Math.abs(plot.valToPos(y, "y") - top);
    if (distance < least) [best, least] = [s, distance];
  });
  return best;
}

function openOnClick(plot, figure) {
  plot.over.addEventListener("click", () => {
    const { idx, top } = plot.cursor;
    const series = idx == null ? null : nearestSeries(plot, idx, top);
    if (series != null) openFrame(figure.lines[series - 1].group, figure.frames[idx]);
  });
}

const heightOf = (figure) => (figure.frames ? 230 : 250);

function options(figure, width) {
  const isTimeline = Boolean(figure.frames);
  const names = (_, ticks) => ticks.map((t) => (figure.frames[t - 1] ?? "").replace(/\.[^.]*$/, ""));
  return {
    width, height: heightOf(figure),
    scales: { x: scaleOf(figure.x), y: scaleOf(figure.y) },
    axes: [axis("x", figure.x, { size: 28, ...(isTimeline ? { values: names, space: 110 } : {}) }),
      axis("y", figure.y, { size: 54 })],
    cursor: { points: { size: 7 }, drag: { x: true, y: false } },
    series: [
      { label: axisLabel(figure.x), value: (_, x) => (x == null ? "" : isTimeline ? figure.frames[x - 1] : short(x)) },
      ...figure.lines.map((line) => ({
        label: line.label || figure.y.label, stroke: colorOf(line.place), width: 2, dash: dashOf(line.place),
        spanGaps: !isTimeline, points: { show: isTimeline, size: 5 }, value: (_, y) => (y == null ? "" : short(y)),
        paths: figure.steps ? uPlot.paths.stepped({ align: 1 }) : undefined,
      })),
    ],
  };
}

class Chart {
  constructor(figure, element) {
    this.figure = figure;
    this.place = element.querySelector(".drawing");
    this.box = el("div", { class: "live" });
    this.place.append(this.box);
    element.classList.add("is-live");
    if (figure.frames && figure.lines.some((line) => hasFrame(line.group))) {
      element.querySelector("figcaption").append(el("span", { class: "note hint" }, "A click opens the frame."));
    }
    this.draw();
    new ResizeObserver(() => this.resize()).observe(this.place);
  }

  draw() {
    this.plot?.destroy();
    const width = Math.max(240, this.place.clientWidth);
    this.plot = new uPlot(options(this.figure, width), dataOf(this.figure), this.box);
    if (this.figure.frames) openOnClick(this.plot, this.figure);
    this.filter();
  }

  resize() {
    const width = this.place.clientWidth;
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width: Math.max(240, width), height: heightOf(this.figure) });
  }

  filter() {
    this.figure.lines.forEach((line, i) => {
      const isOn = isShown(line.group);
      if (this.plot.series[i + 1].show !== isOn) this.plot.setSeries(i + 1, { show: isOn });
    });
  }
}

/// What runs to and fro along x stays a drawing, whose lines come and go.
class Drawing {
  constructor(figure, element) {
    this.figure = figure;
    this.element = element;
    this.filter();
  }

  draw() {}

  filter() {
    this.figure.lines.forEach((line, i) => {
      this.element.querySelector(`[data-line="${i + 1}"]`)?.toggleAttribute("hidden", !isShown(line.group));
    });
  }
}

export function mountCharts() {
  for (const figure of report.figures) {
    const element = document.getElementById(figure.id);
    if (figure.lines?.length > 0 && element) charts.push(new (figure.equal ? Drawing : Chart)(figure, element));
  }
  onFilter(() => charts.forEach((chart) => chart.filter()));
}

export const redrawCharts = () => charts.forEach((chart) => chart.draw());
