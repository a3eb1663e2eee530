// The shapes of points. Colour and shape both tell the kind, so that either alone is enough.

const SHAPES = {
    circle: "M-5,0a5,5 0 1,0 10,0a5,5 0 1,0 -10,0Z",
    diamond: "M0,-8L8,0L0,8L-8,0Z",
    square: "M-4.5,-4.5H4.5V4.5H-4.5Z",
    triangle: "M0,-6L5.5,4.5H-5.5Z",
    cross: "M-2,-6H2V-2H6V2H2V6H-2V2H-6V-2H-2Z",
};

function marker(kind) {
    return svg("path", {class: "marker", d: SHAPES[kind.shape], fill: kind.color});
}

function legendEntry(text, ...shapes) {
    return html("li", {}, svg("svg", {width: 20, height: 18, viewBox: "-10 -9 20 18", "aria-hidden": "true"}, ...shapes), text);
}

function showChartLegend() {
    const kinds = Object.entries(KINDS).filter(([key]) => points.some((point) => point.kind === key));
    byId("chart-legend").replaceChildren(
        ...kinds.map(([, kind]) => legendEntry(kind.name, marker(kind))),
        legendEntry("on the Pareto front", svg("circle", {class: "ring", r: 8}), svg("circle", {r: 3, fill: "var(--muted)"})),
        legendEntry(`${confidenceText()} confidence`, svg("path", {class: "whisker", d: "M-9,0H9M0,-8V8"})),
        legendEntry("what the front attains", svg("path", {class: "front-line", d: "M-9,-5H0V5H9"})),
        legendEntry("noise of the reference", svg("path", {class: "noise", d: "M-9,0H9"})));
}
