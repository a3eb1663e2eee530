// Formats numbers as text, with their units.

const NONE = "–";

function superscript(exponent) {
    return String(exponent).replace(/[-0-9]/g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]));
}

// Returns three significant digits; numbers that would be long get a power of ten.
function number(value, digits = 3) {
    if (value === null || value === undefined || Number.isNaN(value)) {
        return NONE;
    }
    if (!Number.isFinite(value)) {
        return value > 0 ? "∞" : "−∞";
    }
    if (value === 0) {
        return "0";
    }
    const size = Math.abs(value);
    if (size >= 1e-3 && size < 1e5) {
        const text = size >= 10 ** (digits - 1) ? size.toFixed(0) : size.toPrecision(digits);
        return (value < 0 ? "−" : "") + text;
    }
    const [mantissa, exponent] = size.toExponential(digits - 1).split("e");
    return `${value < 0 ? "−" : ""}${mantissa}×10${superscript(Number(exponent))}`;
}

function count(value) {
    return value === null || value === undefined ? NONE : value.toLocaleString("en-US");
}

function withUnit(text, unit) {
    return unit && text !== NONE ? `${text} ${unit}` : text;
}

function milliseconds(value) {
    return withUnit(number(value), "ms");
}

// Returns a confidence interval as "[low, high]".
function range(interval, digits = 3) {
    if (!interval || interval.low === undefined || interval.low === null) {
        return "";
    }
    return `[${number(interval.low, digits)}, ${number(interval.high, digits)}]`;
}

function timeText(interval) {
    return interval ? `${milliseconds(interval.median)} ${range(interval)}`.trim() : NONE;
}

function ratioText(interval) {
    return interval ? `×${number(interval.median)} ${range(interval)}`.trim() : NONE;
}

function percent(share) {
    return isNumber(share) ? `${number(share * 100)} %` : NONE;
}

function bytesText(bytes) {
    if (bytes === null || bytes === undefined) {
        return NONE;
    }
    return bytes < 1024 ? `${bytes} B` : bytes < 1024 ** 2 ? `${number(bytes / 1024)} KiB` : `${number(bytes / 1024 ** 2)} MiB`;
}

function secondsText(seconds) {
    if (seconds === null || seconds === undefined) {
        return NONE;
    }
    return seconds < 120 ? `${number(seconds)} s` : `${number(seconds / 60)} minutes`;
}

// Returns "a, b and c".
function sentenceList(items) {
    return items.length < 2 ? items.join("") : `${items.slice(0, -1).join(", ")} and ${items[items.length - 1]}`;
}

// Returns "1 round" or "7 rounds".
function plural(amount, word) {
    return `${count(amount)} ${word}${amount === 1 ? "" : "s"}`;
}

function shorten(text, length) {
    return text.length <= length ? text : `${text.slice(0, length - 1)}…`;
}
