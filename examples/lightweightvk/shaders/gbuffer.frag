layout(location = 0) in vec4 place;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 outPlace;
layout(location = 1) out vec4 outNormal;
void main() {
    outPlace = place;
    outNormal = vec4(normalize(normal), 0.0);
}
