// Accumulates the samples of a pixel into one value.

// The mean of the samples so far is mean + residual; the residual holds the rounding error of `mean`.
struct RunningMean {
    vec3 mean;
    vec3 residual;
};

// The mean of count + 1 values, from that of the first `count` (Welford 1962). Without the residual each step would
// round the mean, and the error would grow with the root of the count, to 2e-5 at 100,000 samples, where a step is no
// larger. With it (Kahan 1965) the error stays that of one rounding.
RunningMean includeSample(RunningMean last, vec3 value, uint count) {
    precise vec3 change = (value - last.mean - last.residual) / float(count + 1u) + last.residual;
    precise vec3 mean = last.mean + change;
    precise vec3 residual = change - (mean - last.mean);
    return RunningMean(mean, residual);
}

// Returns whether each component is a finite number.
bool isFinite(vec3 v) {
    return !(isnan(v.x) || isinf(v.x) || isnan(v.y) || isinf(v.y) || isnan(v.z) || isinf(v.z));
}
