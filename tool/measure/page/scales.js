// Scales from values to pixels, and their ticks. D3 has these too, but every page would carry its 258 KB.

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
