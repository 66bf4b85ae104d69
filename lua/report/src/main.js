// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// Brings a report's page to life. Without this the page has all its tables, drawings and numbers.
import { mountCharts, redrawCharts } from "./charts.js";
import { button } from "./dom.js";
import { mountFilter } from "./filter.js";
import { mountFrames } from "./frames.js";
import { mountTables } from "./tables.js";
import { mountViewer } from "./viewer/panel.js";

function mountTheme(bar, redraw) {
  const root = document.documentElement;
  const isDark = () => root.dataset.theme === "dark"
    || (!root.dataset.theme && matchMedia("(prefers-color-scheme: dark)").matches);
  const toggle = button("", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    tell();
    redraw();
  }, { class: "quiet theme" });
  const tell = () => { toggle.textContent = isDark() ? "Light" : "Dark"; };
  tell();
  bar.append(toggle);
}

/// What is costly starts when it comes near the window.
function whenNear(id, start) {
  const section = document.getElementById(id);
  if (!section) return;
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    start();
  }, { rootMargin: "400px" });
  observer.observe(section);
}

const bar = document.getElementById("bar");
let view = null;
mountTables();
mountFilter(bar);
mountFrames();
mountCharts();
mountTheme(bar, () => {
  redrawCharts();
  view?.redraw();
});
whenNear("viewer", () => { view = mountViewer(); });
document.documentElement.dataset.ready = "true";
