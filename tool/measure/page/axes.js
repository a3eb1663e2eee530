// The axes of the chart of error against time.

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
