// The report that the page shows, queries on it (docs/schemas/bench.json describes its content), and the choices of the
// user. Each part of the page listens to the choices that it shows.

const report = JSON.parse(byId("report-data").textContent);
const imageData = JSON.parse(byId("image-data").textContent);

const points = report.points ?? [];
const settings = report.settings ?? [];
const pointById = new Map(points.map((point) => [point.id, point]));
const defaultPoint = points.find((point) => point.kind === "default") ?? points[0] ?? null;

const METRICS = [
    {key: "trimmed", name: "relMSE of inliers", log: true,
     what: "relMSE without the 0.1 % of pixels that are worst: a single firefly decides the plain one."},
    {key: "relMse", name: "relMSE", log: true,
     what: "Mean of (A − B)² / (B² + 0.01) over red, green and blue, in linear light, exposed: 1 is white."},
    {key: "rmse", name: "RMSE", log: true, what: "Root of the mean of (A − B)² in linear light, exposed: 1 is white."},
    {key: "psnr", name: "PSNR", unit: "dB", log: false, higherIsBetter: true,
     what: "−20 log₁₀(RMSE): against white. The axis stands on its head, so that lower in the chart is more exact, as for the other measures."},
    {key: "p999", name: "99.9th percentile", log: true,
     what: "The relative error that 99.9 % of the pixels stay below; of a pixel the root of its share in relMSE."},
    {key: "flip", name: "FLIP", log: true,
     what: "Mean of LDR-FLIP: how different the pictures look to somebody who flips between them, from 0 (not at all) to 1."},
    {key: "bias", name: "|bias|", log: true,
     what: "The size of the mean signed relative error. Where its interval holds 0 the whisker goes down to the axis: no bias is shown."},
];

function isNumber(value) {
    return typeof value === "number" && Number.isFinite(value);
}

// Returns the name of a measure's signed number.
function signedName(metric) {
    return metric.key === "bias" ? "bias" : metric.name;
}

function metricOf(key) {
    return METRICS.find((metric) => metric.key === key) ?? METRICS[0];
}

// Returns {value, low, high} of a point's error, or null if it has none. An infinite PSNR is Infinity.
function errorOf(point, metric) {
    const error = point.error?.[metric.key];
    if (metric.key === "bias") {
        return error && isNumber(error.mean) ? biasSize(error) : null;
    }
    if (metric.key === "psnr" && point.error && metric.key in point.error) {
        const orInfinite = (value) => value ?? Infinity;
        return {value: orInfinite(error?.median), low: orInfinite(error?.low), high: orInfinite(error?.high)};
    }
    return error && isNumber(error.median)
        ? {value: error.median, low: error.low ?? error.median, high: error.high ?? error.median} : null;
}

function biasSize({mean, low, high}) {
    const holdsZero = low <= 0 && high >= 0;
    return {value: Math.abs(mean), low: holdsZero ? 0 : Math.min(Math.abs(low), Math.abs(high)),
            high: Math.max(Math.abs(low), Math.abs(high))};
}

// Returns "1.2×10⁻³ [1.1×10⁻³, 1.3×10⁻³]". A bias has a sign.
function errorText(point, metric) {
    const digits = metric.unit === "dB" ? 4 : 3;
    if (metric.key === "bias" && point.error?.bias) {
        const {mean} = point.error.bias;
        return `${mean > 0 ? "+" : ""}${number(mean)} ${range(point.error.bias)}`;
    }
    const error = errorOf(point, metric);
    if (!error) {
        return NONE;
    }
    const text = withUnit(number(error.value, digits), metric.unit);
    return Number.isFinite(error.value) ? `${text} ${range(error, digits)}` : text;
}

// Returns a number that is smaller for a more exact point, for every measure.
function inexactness(point, metric) {
    const error = errorOf(point, metric);
    return error === null ? Infinity : metric.higherIsBetter ? -error.value : error.value;
}

function isMeasured(point) {
    return isNumber(point.time?.median);
}

function timeOf(point) {
    return isMeasured(point) ? point.time.median : Infinity;
}

// Returns the ids of the Pareto front, the fastest first. The report has the front for its own measure; for
// others it is that of the medians.
function frontFor(metric) {
    if (metric.key === ownMetric().key && report.front) {
        return report.front.filter((id) => pointById.has(id));
    }
    let best = Infinity;
    return points.filter((point) => isMeasured(point) && errorOf(point, metric))
        .sort((a, b) => timeOf(a) - timeOf(b) || inexactness(a, metric) - inexactness(b, metric))
        .filter((point) => {
            const better = inexactness(point, metric) < best;
            best = better ? inexactness(point, metric) : best;
            return better;
        })
        .map((point) => point.id);
}

function ownMetric() {
    return metricOf(report.method?.metric);
}

// Returns the value of a setting at a point.
function valueAt(point, setting) {
    return String(point.settings?.[setting.name] ?? setting.default);
}

// Returns the point that differs from the default by this value alone, or that has its name, because some
// values take two options.
function singleOf(setting, value) {
    return points.find((point) => {
        const changed = Object.entries(point.settings ?? {});
        return changed.length === 1 && changed[0][0] === setting.name && String(changed[0][1]) === String(value);
    }) ?? points.find((point) => point.kind !== "default" && point.name === `${setting.name} ${value}`) ?? null;
}

function imageUri(name) {
    return name ? imageData[name] ?? null : null;
}

const KINDS = {
    default: {name: "default", color: "var(--ink)", shape: "diamond"},
    single: {name: "one setting changed", color: "var(--blue)", shape: "circle"},
    pair: {name: "two settings changed", color: "var(--green)", shape: "square"},
    search: {name: "found by the search", color: "var(--purple)", shape: "triangle"},
    package: {name: "another package", color: "var(--orange)", shape: "cross"},
    filtered: {name: "denoised", color: "var(--purple)", shape: "cross"},
    exact: {name: "every approximation off", color: "var(--front)", shape: "triangle"},
};

function kindOf(point) {
    return KINDS[point.kind] ?? KINDS.single;
}

const state = {
    metric: ownMetric().key,
    selected: report.advice?.point ?? defaultPoint?.id ?? null,
    pointed: null,  // the point under the pointer or focused
    kind: "",
    filter: {},  // setting -> value
};
const listeners = [];

// `listener` runs after a change of any of these names.
function onChange(names, listener) {
    listeners.push({names, listener});
}

function change(values) {
    const names = Object.keys(values).filter((name) => state[name] !== values[name]);
    Object.assign(state, values);
    for (const {names: wanted, listener} of listeners) {
        if (names.some((name) => wanted.includes(name))) {
            listener();
        }
    }
}

function isShown(point) {
    return (!state.kind || point.kind === state.kind || point.kind === "default") &&
        settings.every((setting) => !state.filter[setting.name] || valueAt(point, setting) === state.filter[setting.name]);
}

function selectedPoint() {
    return pointById.get(state.selected) ?? null;
}
