"use strict";
(() => {
  const root = document.documentElement;
  const data = JSON.parse(document.getElementById("data").textContent, (_, value) =>
    value && value.bytes !== undefined && value.kind ? unpacked(value) : value);
  const { ink, limit } = data;
  const CLASSES = 15, PALEST = 0.3, RINGS = 10;
  const state = { zone: "", mode: "mean", section: -1, part: 0, magnification: 0 };
  const font = { family: getComputedStyle(document.body).fontFamily, size: 13, color: ink.line };
  const still = { displaylogo: false, responsive: true, showLink: false };
  const tools = (...names) => ({ ...still, scrollZoom: true, modeBarButtons: [names] });
  const all = (selector) => [...document.querySelectorAll(selector)];
  const at = (id) => document.getElementById(id);

  function unpacked({ kind, bytes }) {
    const raw = Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0)).buffer;
    return new { f4: Float32Array, i4: Int32Array, i1: Int8Array }[kind](raw);
  }
  const signed = (x, digits = 4) => (x < 0 ? "−" : "+") + Math.abs(x).toFixed(digits);

  // Colours: the scale of the report, and a pale one for zones that are not picked.
  const rgb = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
  const mixed = (a, b, share) => "rgb(" + a.map((x, k) => Math.round(x + share * (b[k] - x))).join(",") + ")";
  const vivid = data.stops;
  const pale = data.stops.map(([place, hex]) => [place, mixed(rgb(hex), [240, 241, 243], 0.84)]);
  function colour(share) {
    let k = data.stops.findIndex(([place]) => place >= share);
    k = Math.max(k, 1);
    const [a, b] = [data.stops[k - 1], data.stops[k]];
    return mixed(rgb(a[1]), rgb(b[1]), (share - a[0]) / (b[0] - a[0]));
  }
  const clipped = (d) => Math.max(-1, Math.min(1, d / limit));

  // The blade
  const scene = at("scene");
  const light = { ambient: 0.72, diffuse: 0.38, specular: 0.03, roughness: 0.9, fresnel: 0.02 };
  const picked = (mesh) => !state.zone || mesh.zone === state.zone;
  function meshTrace(mesh) {
    const trace = {
      type: "mesh3d", x: mesh.x, y: mesh.y, z: mesh.z, i: mesh.i, j: mesh.j, k: mesh.k,
      lighting: light, lightposition: lamp, name: mesh.zone || "hub and tip", flatshading: false,
      hovertemplate: (mesh.zone || "hub and tip, not inspected") + (mesh.known ? "" : mesh.zone ? ": not measured" : "") + "<extra></extra>",
    };
    if (!mesh.known) return { ...trace, color: plain(mesh) };
    return {
      ...trace, ...paint(mesh), intensitymode: "cell", showscale: false, customdata: cells(mesh),
      hovertemplate: `<b>${mesh.zone}</b><br>mean of the cell %{customdata[0]:+.4f} mm<br>largest %{customdata[1]:+.4f} mm<br>x %{customdata[2]:.2f}, y %{customdata[3]:.2f}, z %{customdata[4]:.2f} mm<extra></extra>`,
    };
  }
  // plotly counts cells here, not vertices, and tells the place of a cell in units of its own
  function cells(mesh) {
    const middle = (values, n) => (values[mesh.i[n]] + values[mesh.j[n]] + values[mesh.k[n]]) / 3;
    return Array.from(mesh.i, (_, n) => [mesh.mean[n], mesh.extreme[n], ...[mesh.x, mesh.y, mesh.z].map((values) => middle(values, n))]);
  }
  const plain = (mesh) => (picked(mesh) || !mesh.zone ? (mesh.zone ? ink.unknown : ink.cap) : "#e4e6e9");
  function paint(mesh) {
    const reach = state.mode === "out" ? 1.6 : limit;
    return { intensity: mesh[state.mode], cmin: -reach, cmax: reach, colorscale: picked(mesh) ? vivid : pale };
  }
  function lineTrace() {
    const line = { x: [], y: [], z: [], customdata: [] };
    data.sections.forEach((section, k) => {
      ["x", "y", "z"].forEach((axis, n) => line[axis].push(...section.track[n], null));
      line.customdata.push(...Array(section.track[0].length + 1).fill(k));
    });
    return { type: "scatter3d", mode: "lines", ...line, line: { color: ink.soft, width: 2 },
      hovertemplate: "%{text}<extra></extra>", text: line.customdata.map((k) => "section " + escaped(data.sections[k].name)) };
  }
  function pickedTrace() {
    const section = data.sections[state.section];
    const [x, y, z] = section ? section.track : [[], [], []];
    return { type: "scatter3d", mode: "lines", x, y, z, line: { color: "#000", width: 7 }, hoverinfo: "skip" };
  }
  function worstTrace() {
    const { at: [x, y, z], deviation, zone } = data.worst;
    const shown = deviation.map((_, k) => k < RINGS && (!state.zone || zone[k] === state.zone));
    const some = (values) => [...values].filter((_, k) => shown[k]);
    return { type: "scatter3d", mode: "markers+text", x: some(x), y: some(y), z: some(z),
      marker: { symbol: "circle-open", size: 6, color: "#000", line: { width: 2, color: "#000" } },
      text: some(deviation.map((_, k) => String(k + 1))), textposition: "top right", textfont: { ...font, size: 14 },
      customdata: some(deviation), hovertemplate: "worst place %{text}: %{customdata:+.4f} mm<extra></extra>" };
  }
  const opening = data.views["suction side"];
  const lamp = { x: 1e4 * opening.eye[0], y: 1e4 * opening.eye[1], z: 1e4 * opening.eye[2] };
  function camera(view) {
    const [x, y, z] = view.eye.map((c) => 0.9 * c);
    const [a, b, c] = view.up;
    return { eye: { x, y, z }, up: { x: a, y: b, z: c }, center: { x: 0, y: 0, z: 0 }, projection: { type: "orthographic" } };
  }
  function drawScene() {
    const traces = [...data.meshes.map(meshTrace), lineTrace(), pickedTrace(), worstTrace()];
    const axis = (title) => ({ title: { text: title + ", mm", font: { ...font, size: 12 } }, showbackground: false, gridcolor: "#eceef1",
      zeroline: false, showspikes: false, tickfont: { ...font, size: 10, color: ink.soft }, nticks: 5 });
    const layout = { margin: { l: 0, r: 0, t: 0, b: 0 }, showlegend: false, font, paper_bgcolor: "#fff",
      scene: { aspectmode: "data", camera: camera(opening), dragmode: "orbit", xaxis: axis("x"), yaxis: axis("y"), zaxis: axis("z") } };
    return Plotly.newPlot(scene, traces, layout, tools("toImage", "zoom3d", "pan3d", "orbitRotation", "resetCameraDefault3d"));
  }
  function recolour() {
    const changes = data.meshes.map((mesh) => (mesh.known ? paint(mesh) : { color: plain(mesh) }));
    const { x, y, z, text, customdata } = worstTrace();
    restyle([...changes, { x, y, z, text, customdata }], [...data.meshes.keys(), data.meshes.length + 2]);
    at("scale").hidden = state.mode === "out";
    at("swatches").hidden = state.mode !== "out";
  }
  function restyle(changes, numbers) { // in one go: each restyle draws the scene anew
    const names = new Set(changes.flatMap(Object.keys));
    const all = Object.fromEntries([...names].map((name) => [name, changes.map((change) => change[name])]));
    return Plotly.restyle(scene, all, numbers);
  }
  function nearestSection([x, y, z]) {
    let best = -1, least = Infinity;
    data.sections.forEach((section, k) => {
      const [X, Y, Z] = section.track;
      for (let n = 0; n < X.length; n++) {
        const away = (X[n] - x) ** 2 + (Y[n] - y) ** 2 + (Z[n] - z) ** 2;
        if (away < least) [best, least] = [k, away];
      }
    });
    return best;
  }

  // plotly tells of a click again in every frame while the button is down, drags too, and from inside the drawing
  function pickUnderMouse() {
    let under = null, down = null;
    const over = ({ points: [{ x, y, z, curveNumber, customdata }] }) => {
      const mesh = data.meshes[curveNumber];
      under = mesh && mesh.known ? customdata.slice(2) : [x, y, z];
    };
    scene.on("plotly_hover", over);
    scene.on("plotly_click", over);
    scene.on("plotly_unhover", () => { under = null; });
    scene.addEventListener("pointerdown", (event) => { down = [event.clientX, event.clientY]; }, true);
    window.addEventListener("pointerup", (event) => {
      const still = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4;
      down = null;
      if (still) setTimeout(() => under && pickSection(nearestSection(under)), 60);
    }, true);
  }

  // The whiskers of one section
  const stage = at("whiskers");
  const magnified = (section) => state.magnification || section.magnification[state.part];
  function escaped(text) { return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;"); }
  function moved(section, distance, m) {
    const n = section.x.length, x = Array(n + 1), y = Array(n + 1);
    for (let k = 0; k <= n; k++) {
      const d = distance ? distance[k % n] : 0;
      x[k] = Number.isNaN(d) ? null : section.x[k % n] + m * d * section.nx[k % n];
      y[k] = Number.isNaN(d) ? null : section.y[k % n] + m * d * section.ny[k % n];
    }
    return { x, y };
  }
  function bristles(section, m) {
    const groups = new Map(), end = moved(section, section.d, m);
    section.d.forEach((d, k) => {
      if (Number.isNaN(d)) return;
      const share = clipped(d), strong = (share < 0 ? -1 : 1) * Math.max(Math.abs(share), PALEST);
      const group = Math.round((0.5 + 0.5 * strong) * (CLASSES - 1));
      if (!groups.has(group)) groups.set(group, { x: [], y: [] });
      groups.get(group).x.push(section.x[k], end.x[k], null);
      groups.get(group).y.push(section.y[k], end.y[k], null);
    });
    return [...groups].map(([group, line]) => ({ type: "scatter", mode: "lines", ...line, hoverinfo: "skip", showlegend: false,
      line: { color: colour(group / (CLASSES - 1)), width: 1.6 } }));
  }
  function whiskerTraces(section, m) {
    const lower = moved(section, section.lower, m), upper = moved(section, section.upper, m);
    const nominal = moved(section, null, 0), actual = moved(section, section.d, m);
    const ring = { x: [...lower.x, ...upper.x.slice().reverse()], y: [...lower.y, ...upper.y.slice().reverse()] };
    const line = (path, name, style, more) => ({ type: "scatter", mode: "lines", ...path, name, line: style, hoverinfo: "skip", ...more });
    const traces = [
      line(ring, "", { width: 0 }, { fill: "toself", fillcolor: "rgba(47,125,79,0.10)", showlegend: false }),
      line(lower, "tolerance band", { color: ink.band, width: 1 }), line(upper, "", { color: ink.band, width: 1 }, { showlegend: false }),
      ...bristles(section, m), line(nominal, "nominal", { color: ink.line, width: 1.8 }),
    ];
    const gaps = [...section.d, section.d[0]].map(Number.isNaN);
    if (gaps.some((gap) => gap)) {
      traces.push(line({ x: nominal.x.map((x, k) => (gaps[k] ? x : null)), y: nominal.y.map((y, k) => (gaps[k] ? y : null)) },
        "not measured", { color: ink.unknown, width: 5 }));
    }
    const n = section.x.length, side = [...section.suction].map((s) => (s ? "suction side" : "pressure side"));
    traces.push({ ...line(actual, "measured", { color: ink.line, width: 1, dash: "4px,2px" }), connectgaps: false, hoverinfo: undefined,
      customdata: [...Array(n + 1)].map((_, k) => [section.d[k % n], section.lower[k % n], section.upper[k % n], section.t[k % n], side[k % n]]),
      hovertemplate: "deviation %{customdata[0]:+.4f} mm<br>band %{customdata[1]:+.4f} to %{customdata[2]:+.4f} mm<br>%{customdata[4]}, t = %{customdata[3]:.4f}<extra></extra>" });
    if (section.worst !== null) {
      const k = section.worst;
      traces.push({ type: "scatter", mode: "markers", x: [actual.x[k]], y: [actual.y[k]], name: "worst place", hoverinfo: "skip",
        marker: { symbol: "circle-open", size: 12, color: section.out ? ink.bad : ink.line, line: { width: 2 } } });
    }
    return { traces, drawn: [lower, upper, nominal, actual], actual };
  }
  function window_(section, drawn) {
    const shown = section.parts[state.part], low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    drawn.forEach((path) => ["x", "y"].forEach((axis, n) => shown.forEach((show, k) => {
      const c = path[axis][k];
      if (!show || c === null || Number.isNaN(c)) return;
      low[n] = Math.min(low[n], c);
      high[n] = Math.max(high[n], c);
    })));
    const wide = stage.clientWidth - 90, tall = stage.clientHeight - 100;
    const half = 0.53 * Math.max((high[0] - low[0]) / wide, (high[1] - low[1]) / tall);
    return [0, 1].map((n) => [-1, 1].map((s) => 0.5 * (low[n] + high[n]) + s * half * [wide, tall][n]));
  }
  function drawSection() {
    const section = data.sections[state.section], m = magnified(section);
    const { traces, drawn, actual } = whiskerTraces(section, m);
    const [x, y] = window_(section, drawn), k = section.worst;
    const axis = (title, range) => ({ title: { text: title, standoff: 6, font }, range, zeroline: false, gridcolor: "#f0f1f3", ticks: "outside", tickcolor: ink.soft });
    const annotations = k === null ? [] : [{ x: actual.x[k], y: actual.y[k], text: `<b>${signed(section.d[k])} mm</b>`, ax: 34, ay: -26,
      font: { ...font, color: section.out ? ink.bad : ink.line }, bgcolor: "rgba(255,255,255,0.85)", arrowwidth: 1, arrowcolor: ink.soft, standoff: 7 }];
    const layout = { margin: { l: 62, r: 18, t: 54, b: 46 }, font, hovermode: "closest", dragmode: "pan", annotations,
      title: { text: `Section ${escaped(section.name)}${section.name.startsWith("u =") ? "" : ", u = " + section.u.toFixed(3)}: deviations magnified × ${m}`, x: 0.012, xanchor: "left", y: 0.965, yanchor: "top", font: { ...font, size: 14 } },
      legend: { orientation: "h", x: 1, xanchor: "right", y: 1.01, yanchor: "bottom" },
      xaxis: axis("along the chord, mm", x), yaxis: { ...axis("across, mm", y), scaleanchor: "x" } };
    return Plotly.react(stage, traces, layout, tools("toImage", "zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d"));
  }

  // The histogram
  function drawHistogram() {
    const { middles, width, zones, counts, bands } = data.histogram, chosen = zones.map((zone) => !state.zone || zone === state.zone);
    const y = [...middles].map((_, k) => counts.reduce((sum, row, z) => sum + (chosen[z] ? row[k] : 0), 0));
    const bounds = [...new Set(bands.filter((_, z) => chosen[z]).flat())];
    const layout = { margin: { l: 70, r: 18, t: 30, b: 48 }, font, bargap: 0.04, showlegend: false,
      xaxis: { title: { text: "deviation, mm; positive: metal outside the nominal", standoff: 6, font }, range: [middles[0] - width, middles[middles.length - 1] + width], zeroline: false, tickformat: ".4~f", gridcolor: "#f0f1f3" },
      yaxis: { title: { text: "points", font }, rangemode: "tozero", gridcolor: "#eceef1" },
      shapes: bounds.map((b) => ({ type: "line", x0: b, x1: b, y0: 0, y1: 1, yref: "paper", line: { color: ink.band, width: 2 } })),
      annotations: bounds.map((b) => ({ x: b, y: 1, yref: "paper", xanchor: "right", yanchor: "top", textangle: -90, text: signed(b, 3), showarrow: false, font: { ...font, size: 11, color: ink.band } })),
      title: { text: state.zone || "all zones", x: 0.012, xanchor: "left", y: 0.97, yanchor: "top", font: { ...font, size: 14 } } };
    const bars = { type: "bar", x: middles, y, width, marker: { color: [...middles].map((d) => colour(0.5 + 0.5 * clipped(d))), line: { color: "#8b9099", width: 0.5 } },
      hovertemplate: "%{y:,} points about %{x:+.4f} mm<extra></extra>" };
    return Plotly.react(at("histogram"), [bars], layout, { ...still, displayModeBar: false });
  }

  // Picking
  const press = (group, chosen) => all(`#${group} button`).forEach((button) => button.setAttribute("aria-pressed", String(chosen(button.dataset))));
  function pickZone(zone) {
    state.zone = zone;
    press("zones", (d) => d.zone === zone);
    all("tr[data-zone]").forEach((row) => row.classList.toggle("picked", row.dataset.zone === zone));
    if (drawn3d) recolour();
    drawHistogram();
  }
  function pickMode(mode) {
    state.mode = mode;
    press("modes", (d) => d.mode === mode);
    if (drawn3d) recolour();
  }
  function pickSection(number) {
    if (number < 0 || number >= data.sections.length) return;
    state.section = number;
    press("stations", (d) => Number(d.section) === number);
    all(".station").forEach((article, k) => article.classList.toggle("shown", k === number));
    fillMagnifications();
    drawSection();
    if (!drawn3d) return;
    const { x, y, z } = pickedTrace();
    restyle([{ x, y, z }], [data.meshes.length + 1]);
  }
  function pickPart(part) {
    Object.assign(state, { part, magnification: 0 });
    press("parts", (d) => Number(d.part) === part);
    fillMagnifications();
    drawSection();
  }
  function fillMagnifications() {
    const best = data.sections[state.section].magnification[state.part];
    const steps = new Set([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, best, state.magnification || best]);
    const select = at("magnification");
    select.replaceChildren(...[...steps].sort((a, b) => a - b).map((m) => new Option(m + (m === best ? " (fits)" : ""), m)));
    select.value = state.magnification || best;
  }
  function onPress(group, act) {
    const box = at(group);
    if (box) box.addEventListener("click", (event) => {
      const button = event.target.closest("button");
      if (button) act(button.dataset);
    });
  }

  let drawn3d = false;
  function webgl() {
    try { return Boolean(document.createElement("canvas").getContext("webgl")); } catch { return false; }
  }
  async function start() {
    root.classList.add("js");
    onPress("zones", (d) => pickZone(d.zone));
    onPress("modes", (d) => pickMode(d.mode));
    onPress("stations", (d) => pickSection(Number(d.section)));
    onPress("parts", (d) => d.part !== undefined && pickPart(Number(d.part)));
    onPress("views", (d) => Plotly.relayout(scene, { "scene.camera": camera(data.views[d.view]) }));
    all("tr[data-zone]").forEach((row) => row.addEventListener("click", () => pickZone(state.zone === row.dataset.zone ? "" : row.dataset.zone)));
    all("#stations .dot").forEach((dot, k) => { dot.hidden = !data.sections[k].out; });
    drawHistogram();
    if (data.sections.length) {
      at("magnification").addEventListener("change", (event) => { state.magnification = Number(event.target.value); drawSection(); });
      pickSection(all(".station").findIndex((article) => article.classList.contains("shown")));
    }
    if (webgl()) {
      await drawScene();
      drawn3d = true;
      pickUnderMouse();
    } else {
      root.classList.add("no-webgl");
    }
    requestAnimationFrame(() => requestAnimationFrame(() => { root.dataset.ready = String(Math.round(performance.now())); }));
  }
  async function unpackPlotly() {
    const raw = Uint8Array.from(atob(at("plotly").textContent), (c) => c.charCodeAt(0));
    const code = await new Response(new Blob([raw]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
    const script = document.createElement("script");
    script.textContent = code;
    document.head.append(script);
  }
  if (typeof DecompressionStream === "function") unpackPlotly().then(start);
})();
