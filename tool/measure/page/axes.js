// The scales, the axes, the markers and the labels of charts. D3 has scales and ticks, too, but every page would carry
// its 258 KB.

// Returns about `wanted` multiples of 1, 2 or 5 times a power of ten within [low, high].
function linearTicks(low, high, wanted) {
    const raw = (high - low) / wanted;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = power * ([1, 2, 5].find((factor) => factor * power >= raw) ?? 10);
    const ticks = [];
    for (let i = Math.ceil(low / step); i * step <= high * (1 + 1e-12); ++i) {
        ticks.push(Number((i * step).toPrecision(12)));
    }
    return ticks;
}

// Returns powers of ten, with their multiples by 2 and 5 if there is room. Within less than a decade, ticks
// are linear.
function logTicks(low, high, wanted) {
    const decades = Math.log10(high / low);
    if (decades < 0.7) {
        return linearTicks(low, high, wanted);
    }
    const factors = decades * 3 <= wanted * 1.5 ? [1, 2, 5] : [1];
    const every = factors.length === 1 ? Math.max(1, Math.ceil(decades / wanted)) : 1;
    const ticks = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power) {
        if (power % every === 0) {
            for (const factor of factors) {
                const tick = Number(`${factor}e${power}`);
                if (tick >= low * (1 - 1e-12) && tick <= high * (1 + 1e-12)) {
                    ticks.push(tick);
                }
            }
        }
    }
    return ticks;
}

// Returns a scale from [low, high] to [from, to]. Call it with a value; `ticks` are values.
function makeScale({log, low, high, from, to, ticks}) {
    const map = log ? Math.log10 : (value) => value;
    const start = map(low);
    const length = map(high) - start;
    const scale = (value) => from + ((map(value) - start) / length) * (to - from);
    scale.ticks = (log ? logTicks : linearTicks)(low, high, ticks);
    scale.low = low;
    scale.high = high;
    return scale;
}

// Returns the extent of values with some room at both ends. Its length is never 0.
function paddedExtent(values, log) {
    let low = Math.min(...values);
    let high = Math.max(...values);
    if (log) {
        const room = Math.max((high / low) ** 0.06, 1.05);
        return [low / room, high * room];
    }
    const room = Math.max((high - low) * 0.06, Math.abs(high) * 0.01, 1e-9);
    return [low - room, high + room];
}

const MARGIN = {left: 74, right: 16, top: 14, bottom: 46};
// Height of the area below the plot for points that a logarithmic axis can't show.
const LANE = 26;

// The noise of the reference is drawn only if some error is less than this many times as large. Farther down
// it would take most of the chart.
const FARTHEST_NOISE = 50;

function noiseOf(metric) {
    const noise = metric.higherIsBetter ? null : report.reference?.noise?.[metric.key];
    return isNumber(noise) && noise > 0 ? noise : null;
}

// Clips a drawing to the plot.
function clipped(axes, ...children) {
    const width = axes.width - MARGIN.right - MARGIN.left;
    const height = axes.height - MARGIN.bottom - MARGIN.top;
    return svg("svg", {x: MARGIN.left, y: MARGIN.top, width, height, viewBox: `${MARGIN.left} ${MARGIN.top} ${width} ${height}`,
                       "aria-hidden": "true"}, ...children);
}

function makeAxes(width, height, metric, shown) {
    const errors = shown.map((point) => errorOf(point, metric));
    const onAxis = (value) => isNumber(value) && (!metric.log || value > 0);
    const lane = errors.some((error) => !onAxis(error.value));
    // Whiskers that reach zero don't stretch a logarithmic axis.
    const values = errors.flatMap((error) => [error.value, error.low, error.high]).filter(onAxis);
    const noise = noiseOf(metric);
    const floor = onAxis(noise) && values.some((value) => value < noise * FARTHEST_NOISE) ? noise : null;
    const xs = shown.flatMap((point) => [point.time.median, point.time.low, point.time.high]).filter((value) => value > 0);
    const [low, high] = paddedExtent(values.length > 0 ? [...values, ...(floor === null ? [] : [floor])] : [1, 10], metric.log);
    const [first, last] = paddedExtent(xs.length > 0 ? xs : [1, 10], true);
    const bottom = height - MARGIN.bottom - (lane ? LANE : 0);
    const x = makeScale({log: true, low: first, high: last, from: MARGIN.left, to: width - MARGIN.right, ticks: width < 600 ? 4 : 8});
    // Less error is drawn lower. For a measure that grows with exactness, the highest value is at the bottom.
    const ends = metric.higherIsBetter ? {from: MARGIN.top, to: bottom} : {from: bottom, to: MARGIN.top};
    const y = makeScale({log: metric.log, low, high, ...ends, ticks: 7});
    const laneMiddle = height - MARGIN.bottom - (lane ? LANE / 2 : 0);
    const place = (value) => (onAxis(value) ? y(Math.min(Math.max(value, low), high)) : laneMiddle);
    return {x, y: place, yTicks: y.ticks, bottom, lane, floor, hasErrors: values.length > 0, width, height};
}

function drawAxes(axes, metric) {
    const {x, y, width, height, bottom} = axes;
    const right = width - MARGIN.right;
    const base = height - MARGIN.bottom;
    return svg("g", {class: "axes", "aria-hidden": "true"},
        x.ticks.map((tick) => [
            svg("path", {class: "grid", d: `M${x(tick)},${MARGIN.top}V${base}`}),
            svg("text", {x: x(tick), y: base + 18, "text-anchor": "middle"}, tickText(tick)),
        ]),
        axes.yTicks.map((tick) => [
            svg("path", {class: "grid", d: `M${MARGIN.left},${y(tick)}H${right}`}),
            svg("text", {x: MARGIN.left - 8, y: y(tick) + 4, "text-anchor": "end"}, tickText(tick)),
        ]),
        svg("path", {class: "axis", d: `M${MARGIN.left},${MARGIN.top}V${bottom}M${MARGIN.left},${base}H${right}`}),
        axes.lane ? [svg("path", {class: "grid", d: `M${MARGIN.left},${bottom}H${right}`}),
                     svg("text", {x: MARGIN.left - 8, y: base - LANE / 2 + 4, "text-anchor": "end"}, metric.higherIsBetter ? "∞" : "0")] : [],
        svg("text", {class: "axis-name", x: (MARGIN.left + right) / 2, y: height - 6, "text-anchor": "middle"},
            "time of one picture, ms (logarithmic)"),
        svg("text", {class: "axis-name", transform: `translate(14 ${(MARGIN.top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle"},
            `${metric.name}${metric.unit ? `, ${metric.unit}` : ""}${metric.log ? " (logarithmic)" : ", upside down"}`));
}

// Shows as many digits as the tick has.
function tickText(tick) {
    const digits = Number(tick.toPrecision(12)).toExponential().split("e")[0].replace(/[-.]/g, "").length;
    return number(tick, digits);
}

// Colour and shape both tell the kind of a point, so that either alone is enough.
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

// Names of points do not overlap each other and, if possible, do not hide points.

const LABEL_HEIGHT = 15;

function overlap(a, b) {
    return Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
        Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
}

function boxAround(x, y, width, height) {
    return {left: x - width / 2, right: x + width / 2, top: y - height / 2, bottom: y + height / 2};
}

// Returns small boxes along a line of {x, y}.
function boxesAlong(corners) {
    return corners.slice(1).flatMap((end, i) => {
        const start = corners[i];
        const steps = Math.max(1, Math.ceil(Math.hypot(end.x - start.x, end.y - start.y) / 6));
        return Array.from({length: steps}, (_, step) => {
            const along = step / steps;
            return boxAround(start.x + (end.x - start.x) * along, start.y + (end.y - start.y) * along, 6, 6);
        });
    });
}

// Returns boxes for a label of this width around a point, the nearest first.
function candidates(anchor, width) {
    const boxes = [];
    for (const distance of [11, 20, 34, 52, 74, 100, 130]) {
        for (const [dx, dy] of [[1, 0], [0.7, -0.7], [0.7, 0.7], [0, -1], [0, 1], [-1, 0], [-0.7, -0.7], [-0.7, 0.7]]) {
            const x = anchor.x + dx * distance + Math.sign(dx) * width / 2;
            const y = anchor.y + dy * (distance + LABEL_HEIGHT / 2);
            boxes.push({...boxAround(x, y, width, LABEL_HEIGHT), distance});
        }
    }
    return boxes;
}

// Two neighbouring labels must not read as one, so each box is widened.
function widened(box) {
    return {...box, left: box.left - 6, right: box.right + 6};
}

// anchors: {x, y, width} of each label; obstacles: boxes that labels should not hide; within: the plot's box.
// Returns a box or null for each label. A name that fits nowhere is only in the list below the chart.
function placeLabels(anchors, obstacles, within) {
    const taken = [];
    return anchors.map((anchor) => {
        let best = null;
        let leastCost = Infinity;
        for (const box of candidates(anchor, anchor.width)) {
            const inside = box.left >= within.left && box.right <= within.right && box.top >= within.top && box.bottom <= within.bottom;
            if (!inside || taken.some((other) => overlap(widened(box), other) > 0)) {
                continue;
            }
            const hidden = obstacles.reduce((sum, other) => sum + overlap(box, other), 0);
            const cost = box.distance + hidden * 3;
            if (cost < leastCost) {
                leastCost = cost;
                best = box;
            }
        }
        if (best) {
            taken.push(best);
        }
        return best;
    });
}

// Returns a line from a point to a label that is not beside it.
function leader(anchor, box) {
    const x = Math.min(Math.max(anchor.x, box.left), box.right);
    const y = Math.min(Math.max(anchor.y, box.top), box.bottom);
    return Math.hypot(x - anchor.x, y - anchor.y) > 18 ? svg("path", {class: "leader", d: `M${anchor.x},${anchor.y}L${x},${y}`}) : null;
}
