// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// What a result shows in three dimensions: layers of points, faces and cameras.
///
/// A layer is { title, object (of three.js), isOn, colorings = [{ label, unit, values, isNone }], count, pick(...) }.
import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Mesh, Points, Vector3 } from "three";
import { none16, numbers, report, valueOf } from "../data.js";
import { rough, short } from "../dom.js";
import { isPartOf, nameOf } from "../filter.js";
import { faceMaterial, pointMaterial } from "./materials.js";

const kinds = new Set(["cloud", "mesh", "cameras"]);
const views = report.views.filter((view) => kinds.has(view.kind) && !view.is_left_out);

/// What is too large to be here.
export const leftOut = report.views.filter((view) => view.is_left_out)
  .map((view) => `The mesh of ${nameOf(view.group)} has ${view.n_triangles} faces, too many for a page.`);

/// Groups that have geometry and are not part of another one: those are what can be looked at.
export const places = [...new Map(views.map((view) => [nameOf(view.group), view.group])).values()]
  .filter((group, _, all) => !all.some((other) => other !== group && isPartOf(group, other)));

const count = (n) => n.toLocaleString("en").replaceAll(",", "\u202f");

function placed(object, box, centre) {
  object.position.set(...box.min.map((x, k) => x - centre[k]));
  object.scale.set(...box.max.map((x, k) => Math.max(x - box.min[k], 1e-9) * (65535 / 65534)));
  object.frustumCulled = false;
  return object;
}

async function stepsOf(values) {
  return { steps: await numbers(values.data, Uint16Array), low: values.low, high: values.high };
}

/// Shows one of a layer's values, or none.
function colorBy(layer, coloring) {
  const { uniforms } = layer.object.material;
  uniforms.isColored.value = Boolean(coloring);
  layer.coloring = coloring;
  if (!coloring) return;
  uniforms.valueRange.value.set(coloring.low, coloring.high);
  layer.object.geometry.setAttribute("step", coloring.attribute);
}

const told = (coloring, i) => {
  const value = valueOf(coloring.steps[i], coloring);
  return `${coloring.label}: ${Number.isNaN(value) ? "none" : `${short(value)} ${coloring.unit ?? ""}`}`;
};

const looks = {
  estimate: { title: "Estimate", plain: [0.9, 0.45, 0.1], isOn: true },
  reference: { title: "Truth, sampled", plain: [0.35, 0.6, 0.75], isOn: false },
};

async function cloudLayer(view, centre) {
  const look = looks[view.role] ?? { title: view.role, plain: [0.6, 0.6, 0.6], isOn: true };
  const positions = await numbers(view.positions, Uint16Array);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3, true));
  const object = placed(new Points(geometry, pointMaterial(look.plain)), view.box, centre);
  const colorings = [];
  if (view.values) {
    const values = await stepsOf(view.values);
    colorings.push({ ...values, label: view.label ?? "value", unit: view.unit,
      attribute: new BufferAttribute(values.steps, 1, false) });
  }
  const thinned = view.voxel > 0 ? `, one a voxel of ${rough(view.voxel)}, of ${count(view.n_given)}` : "";
  const layer = { title: look.title, object, colorings, isOn: look.isOn, count: `${count(view.n)} points${thinned}`,
    picks: "points", tell: (i) => `${look.title}: ${layer.coloring ? told(layer.coloring, i) : "a point"}` };
  layer.colorBy = (coloring) => colorBy(layer, coloring);
  layer.colorBy(colorings[0]);
  return layer;
}

async function meshLayer(view, centre) {
  const [positions, triangles] = await Promise.all(
    [numbers(view.positions, Uint16Array), numbers(view.triangles, Uint32Array)]);
  const corners = new Uint16Array(3 * triangles.length);
  triangles.forEach((vertex, i) => corners.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i));
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(corners, 3, true));
  const object = placed(new Mesh(geometry, faceMaterial([0.62, 0.64, 0.66])), view.box, centre);
  const colorings = await Promise.all(view.faces.map(async (face) => {
    const values = await stepsOf(face.values);
    const ofCorners = new Uint16Array(triangles.length).map((_, i) => values.steps[Math.floor(i / 3)]);
    return { ...values, label: face.label, unit: face.unit, attribute: new BufferAttribute(ofCorners, 1, false) };
  }));
  const layer = { title: "True mesh", object, colorings, isOn: true, count: `${count(view.n_triangles)} faces`,
    picks: "faces", tell: (i) => `Face of the true mesh: ${
      colorings.map((coloring) => told(coloring, i)).join("; ") || "no value"}` };
  layer.colorBy = (coloring) => colorBy(layer, coloring);
  layer.colorBy(undefined);
  return layer;
}

const cornersOfFrustum = [[-1, -0.6, 1.4], [1, -0.6, 1.4], [1, 0.6, 1.4], [-1, 0.6, 1.4]];
const edges = [[0, 1], [0, 2], [0, 3], [0, 4], [1, 2], [2, 3], [3, 4], [4, 1]];

const centreOf = (pose, centre) => pose.slice(0, 3).map((x, k) => x - centre[k]);

/// Line ends of a camera's frustum.
function frustum(pose, centre, size) {
  const apex = centreOf(pose, centre);
  const at = (corner) => apex.map((x, row) =>
    x + size * corner.reduce((sum, c, column) => sum + c * pose[3 + 3 * row + column], 0));
  const ends = [apex, ...cornersOfFrustum.map(at)];
  return edges.flatMap(([a, b]) => [...ends[a], ...ends[b]]);
}

function lines(ends, color) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends), 3));
  const object = new LineSegments(geometry, new LineBasicMaterial({ color }));
  object.frustumCulled = false;
  return object;
}

const colors = { estimate: 0x1f9bff, reference: 0x8a8f98, error: 0xff3d2e, missing: 0xff8c00 };

/// A cross in space, as large as a frustum.
const cross = (p, size) => [0, 1, 2].flatMap((k) => [-1, 1].flatMap((sign) => p.map((x, i) => x + (i === k ? sign * size : 0))));

function camerasLayer(view, centre, size) {
  const estimates = new Map(view.estimate.filter((c) => c.pose.length).map((c) => [c.name, c.pose]));
  const missing = new Set(view.missing);
  const truth = view.reference.filter((c) => c.pose.length);
  const group = new Group();
  const parts = { estimate: [], reference: [], error: [], missing: [] };
  for (const pose of estimates.values()) parts.estimate.push(...frustum(pose, centre, size));
  for (const { name, pose } of truth) {
    if (missing.has(name)) parts.missing.push(...cross(centreOf(pose, centre), size / 2));
    else parts.reference.push(...frustum(pose, centre, size));
    const estimate = estimates.get(name);
    if (estimate) parts.error.push(...centreOf(estimate, centre), ...centreOf(pose, centre));
  }
  for (const [part, ends] of Object.entries(parts)) group.add(lines(ends, colors[part]));
  const errors = view.errors ?? {};
  const cameras = [
    ...truth.map(({ name, pose }) => ({ name, at: centreOf(pose, centre), isTruth: true })),
    ...[...estimates].map(([name, pose]) => ({ name, at: centreOf(pose, centre), isTruth: false })),
  ];
  return { title: "Cameras", object: group, colorings: [], isOn: true, picks: "cameras", cameras,
    count: `${estimates.size} of ${truth.length}${missing.size ? `, ${missing.size} missing` : ""}`,
    legend: [["estimated", colors.estimate], ["true", colors.reference], ["error", colors.error], ["missing", colors.missing]],
    frame: (i) => cameras[i].name,
    tell: (i) => {
      const { name } = cameras[i];
      if (missing.has(name)) return `Camera ${name}: no pose was estimated`;
      return `Camera ${name}${errors[name] == null ? "" : `: ${short(errors[name])} m from the truth`}`;
    } };
}

function boundsOf(ofPlace) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const add = (p) => p.forEach((x, k) => {
    low[k] = Math.min(low[k], x);
    high[k] = Math.max(high[k], x);
  });
  for (const view of ofPlace) {
    if (view.box) [view.box.min, view.box.max].forEach(add);
    else view.reference.filter((c) => c.pose.length).forEach((c) => add(c.pose.slice(0, 3)));
  }
  return { low, high };
}

/// Box of what is looked at: around the true cameras, else the true points, else everything.
function focusOf(ofPlace) {
  for (const isMeant of [(view) => view.kind === "cameras", (view) => view.role === "reference"]) {
    const near = ofPlace.filter(isMeant);
    if (near.length) return boundsOf(near);
  }
  return boundsOf(ofPlace);
}

/// One mesh of several is enough: that which has values.
function withoutRepeats(ofPlace) {
  const meshes = ofPlace.filter((view) => view.kind === "mesh").sort((a, b) => b.faces.length - a.faces.length);
  return ofPlace.filter((view) => view.kind !== "mesh" || view === meshes[0]);
}

/// The layers of a place and the box that holds what matters, counted from its own centre of map.
export async function layersOf(place, origin) {
  const ofPlace = withoutRepeats(views.filter((view) => isPartOf(view.group, place)));
  const focus = focusOf(ofPlace);
  const centre = origin ?? focus.low.map((x, k) => (x + focus.high[k]) / 2);
  const extent = Math.hypot(...focus.high.map((x, k) => x - focus.low[k]));
  const make = { cloud: cloudLayer, mesh: meshLayer, cameras: camerasLayer };
  const layers = await Promise.all(ofPlace.map((view) => make[view.kind](view, centre, extent / 45)));
  const shift = (p) => new Vector3(...p.map((x, k) => x - centre[k]));
  return { layers, centre, low: shift(focus.low), high: shift(focus.high) };
}

/// The value below which 95 % of a coloring lie: where the colours end.
export function highOf(coloring) {
  const steps = coloring.steps.filter((step) => step !== none16).sort();
  return steps.length ? valueOf(steps[Math.floor(0.95 * (steps.length - 1))], coloring) : 1;
}
