// Sums and products that keep their rounding errors. A fused multiply-add would be shorter, but GLSL's fma() need not
// be fused. `precise` keeps compilers from simplifying the errors away.

// The exact error of fl(a * b): Dekker 1971, with Veltkamp's split at 12 bits.
float productError(float a, float b, float product) {
    const float kSplit = 4097.0;
    precise float bigA = kSplit * a;
    precise float highA = bigA - (bigA - a);
    precise float lowA = a - highA;
    precise float bigB = kSplit * b;
    precise float highB = bigB - (bigB - b);
    precise float lowB = b - highB;
    precise float error = ((highA * highB - product) + highA * lowB + lowA * highB) + lowA * lowB;
    return error;
}

// The exact error of fl(a + b): Knuth 1969.
float sumError(float a, float b, float sum) {
    precise float partB = sum - a;
    precise float error = (a - (sum - partB)) + (b - partB);
    return error;
}

// Returns a + b as a float and its error.
vec2 exactSum(float a, float b) {
    precise float sum = a + b;
    return vec2(sum, sumError(a, b, sum));
}

// Returns a + b c as a float and its error.
vec2 exactAddProduct(float a, float b, float c) {
    precise float product = b * c;
    precise float sum = a + product;
    return exactSum(sum, sumError(a, product, sum) + productError(b, c, product));
}

// Returns a + b c with about one rounding, even where the sum cancels.
float addProduct(float a, float b, float c) {
    return exactAddProduct(a, b, c).x;
}

// Returns a b - c d with full relative precision: Kahan's difference of products.
float differenceOfProducts(float a, float b, float c, float d) {
    precise float first = a * b;
    precise float second = c * d;
    precise float result = (first - second) + (productError(a, b, first) - productError(c, d, second));
    return result;
}

// Returns the square of x.x + x.y, where x.y is the rounding error of x.x, as a float and its error.
vec2 exactSquare(vec2 x) {
    precise float square = x.x * x.x;
    return vec2(square, productError(x.x, x.x, square) + 2.0 * x.x * x.y);
}

// The squared cosine on the far side of an interface of relative index eta = n_t / n_i, by Snell's law. It is negative
// beyond the critical angle. Near that angle, where reflectance is steepest, 1 - (1 - cosine²) / eta² would lose its
// digits. That is so bad that the squared cosine of the near side must come with its error.
float refractedCosine2(vec2 cosine2, float eta) {
    vec2 eta2 = exactSquare(vec2(eta, 0.0));
    vec2 sum = exactSum(cosine2.x, eta2.x);
    precise float result = ((sum.x - 1.0) + (sum.y + cosine2.y + eta2.y)) / eta2.x;
    return result;
}

// Returns dot(a, b) as a float and its error.
vec2 exactDot(vec3 a, vec3 b) {
    // One component after the other, so that the halves of few numbers wait in registers.
    precise float x = a.x * b.x;
    precise float errors = productError(a.x, b.x, x);
    precise float y = a.y * b.y;
    precise float xy = x + y;
    errors += productError(a.y, b.y, y) + sumError(x, y, xy);
    precise float z = a.z * b.z;
    precise float sum = xy + z;
    errors += productError(a.z, b.z, z) + sumError(xy, z, sum);
    return exactSum(sum, errors);
}

// Returns dot(a, b), accurate near 0.
float accurateDot(vec3 a, vec3 b) {
    return exactDot(a, b).x;
}

// The squared cosine between a (or b) and their half vector, with its error: a quarter of |a + b|². a and b are unit
// vectors.
vec2 halfCosine2(vec3 a, vec3 b) {
    vec2 x = exactSum(a.x, b.x);
    vec2 y = exactSum(a.y, b.y);
    vec2 z = exactSum(a.z, b.z);
    vec2 x2 = exactSquare(x);
    vec2 y2 = exactSquare(y);
    vec2 z2 = exactSquare(z);
    vec2 xy = exactSum(x2.x, y2.x);
    vec2 sum = exactSum(xy.x, z2.x);
    return 0.25 * exactSum(sum.x, sum.y + xy.y + x2.y + y2.y + z2.y);
}

// Returns cross(n, a + b), accurate where a + b is near n. It is the sine between a normal and an unnormalised half
// vector.
vec3 accurateCrossOfSum(vec3 n, vec3 a, vec3 b) {
    precise vec3 s = a + b;
    vec3 low = vec3(sumError(a.x, b.x, s.x), sumError(a.y, b.y, s.y), sumError(a.z, b.z, s.z));
    vec3 high = vec3(differenceOfProducts(n.y, s.z, n.z, s.y), differenceOfProducts(n.z, s.x, n.x, s.z),
                     differenceOfProducts(n.x, s.y, n.y, s.x));
    return high + cross(n, low);
}
