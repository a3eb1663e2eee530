// Draws stacked bars: the passes of some points.

// The colours of Okabe and Ito, without black.
const PASS_COLORS = ["#E69F00", "#56B4E9", "#009E73", "#F0E442", "#0072B2", "#D55E00", "#CC79A7"];
const OTHER = "other passes";

// The passes that take the most time over all points have a colour each; the rest share one.
let passColors = new Map();

function choosePassColors() {
    const totals = new Map();
    for (const pass of points.flatMap((point) => point.passes ?? [])) {
        totals.set(pass.name, (totals.get(pass.name) ?? 0) + (pass.median ?? 0));
    }
    const names = [...totals.keys()].sort((a, b) => totals.get(b) - totals.get(a));
    return new Map(names.slice(0, PASS_COLORS.length).map((name, i) => [name, PASS_COLORS[i]]));
}

function passGroups() {
    const groups = [["selected", "the default, the advised and the selected one"], ["front", "the Pareto front"]];
    for (const setting of settings) {
        if (settingPoints(setting).length > 1) {
            groups.push([`setting ${setting.name}`, `values of ${setting.name}`]);
        }
    }
    return groups;
}

// Returns the default and the points that change this setting alone.
function settingPoints(setting) {
    return setting.values.map((value) => (String(value) === String(setting.default) ? defaultPoint : singleOf(setting, value)))
        .filter((point) => point);
}

function pointsOfGroup(group) {
    const setting = settings.find(({name}) => group === `setting ${name}`);
    const chosen = setting ? settingPoints(setting)
        : group === "front" ? frontFor(metricOf(state.metric)).map((id) => pointById.get(id)) : [defaultPoint, pointById.get(report.advice?.point), selectedPoint()];
    return [...new Set(chosen)].filter((point) => point?.passes?.length > 0);
}

function showPasses() {
    if (!points.some((point) => point.passes?.length > 0)) {
        hideSection("passes");
        return;
    }
    passColors = choosePassColors();
    fillSelect(byId("passes-of"), passGroups(), "selected", drawPasses);
    byId("passes-scale").addEventListener("change", drawPasses);
    onChange(["selected", "metric"], drawPasses);
    drawPasses();
}

function segmentsOf(point) {
    const coloured = point.passes.filter((pass) => passColors.has(pass.name));
    const rest = point.passes.filter((pass) => !passColors.has(pass.name));
    const order = [...passColors.keys()];
    const segments = coloured.sort((a, b) => order.indexOf(a.name) - order.indexOf(b.name))
        .map((pass) => ({name: pass.name, ms: pass.median ?? 0, color: passColors.get(pass.name),
                         text: `${pass.name}: ${milliseconds(pass.median)} (quartiles ${number(pass.q1)} to ${number(pass.q3)})`}));
    if (rest.length > 0) {
        segments.push({name: OTHER, ms: rest.reduce((sum, pass) => sum + (pass.median ?? 0), 0), color: "var(--muted)",
                       text: rest.map((pass) => `${pass.name}: ${milliseconds(pass.median)}`).join("\n")});
    }
    return segments;
}

function drawPasses() {
    const asShares = byId("passes-scale").value === "share";
    const bars = pointsOfGroup(byId("passes-of").value).map((point) => {
        const segments = segmentsOf(point);
        const sum = segments.reduce((total, segment) => total + segment.ms, 0);
        return {point, segments, sum, perMs: asShares ? 100 / Math.max(sum, 1e-12) : 1};
    });
    const box = byId("pass-box");
    const width = Math.max(300, Math.floor(box.clientWidth));
    const longest = asShares ? 100 : Math.max(...bars.map(({sum}) => sum), 1e-9);
    const x = makeScale({log: false, low: 0, high: longest, from: 0, to: width - 90, ticks: width < 600 ? 4 : 8});
    const rowHeight = 44;
    const height = bars.length * rowHeight + 26;
    const unit = asShares ? "%" : "ms";
    box.replaceChildren(svg("svg", {id: "pass-bars", width, height, viewBox: `0 0 ${width} ${height}`, role: "img",
                                    "aria-label": `Times of passes: ${bars.map((bar) => barText(bar)).join("; ")}`},
        x.ticks.map((tick) => [svg("path", {class: "grid", d: `M${x(tick) + 0.5},0V${height - 22}`}),
                               svg("text", {x: x(tick), y: height - 6, "text-anchor": tick === 0 ? "start" : "middle"},
                                   tick === 0 ? `0 ${unit}` : tickText(tick))]),
        bars.map((bar, index) => drawBar(bar, index * rowHeight, x))));
    const other = points.some((point) => point.passes?.some((pass) => !passColors.has(pass.name)));
    byId("pass-legend").replaceChildren(...[...passColors, ...(other ? [[OTHER, "var(--muted)"]] : [])].map(([name, color]) =>
        legendEntry(name, svg("rect", {x: -7, y: -6, width: 13, height: 13, fill: color}))));
}

function barText({point, segments}) {
    return `${point.name}: ${segments.map((segment) => `${segment.name} ${milliseconds(segment.ms)}`).join(", ")}`;
}

function drawBar({point, segments, sum, perMs}, top, x) {
    let end = 0;
    const rects = segments.map((segment) => {
        const left = x(end);
        end += segment.ms * perMs;
        return svg("rect", {class: "segment", x: left, y: top + 18, width: Math.max(0, x(end) - left), height: 18, fill: segment.color},
                   svg("title", {}, segment.text));
    });
    return svg("g", {class: "bar", "data-id": point.id}, svg("text", {class: "bar-name", x: 0, y: top + 13}, shorten(point.name, 60)), rects,
               svg("text", {x: x(end) + 6, y: top + 32}, milliseconds(sum)));
}
