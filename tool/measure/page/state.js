// The choices of the user. Each part of the page listens to the values that it shows.

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
