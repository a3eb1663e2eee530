layout(location = 0) out vec4 place;
layout(location = 1) out vec3 normal;
void main() {
    Object object = frame.objects.data[drawn];
    uint first = 3u * object.indices.data[gl_VertexIndex];
    for (uint i = 0u; i < 3u; ++i) {
        place[i] = object.positions.data[first + i];
        normal[i] = object.normals.data[first + i];
    }
    place.x += object.moved;
    gl_Position = frame.toClip * vec4(place.xyz, 1.0);
    place.w = 1.0 + float(drawn);  // 0 where nothing is seen
}
