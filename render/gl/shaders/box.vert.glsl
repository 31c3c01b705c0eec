// The faces of each box that look at the eye, or at the light: at most one of each opposite pair.

flat out uint tag;

void main() {
#ifdef SHADOW
  int body = after.z + gl_VertexID / 18;
#else
  int body = begin.x + gl_VertexID / 18;
#endif
  int axis = gl_VertexID % 18 / 6;
  // The two triangles of a face: corners 0 1 2 and 2 1 3, of which bit 0 and bit 1 are the signs.
  int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
  vec3 centre = texel_of(body, 0).xyz;
  vec4 orientation = texel_of(body, 1);
  vec3 half_extents = texel_of(body, 2).xyz;
#ifdef SHADOW
  float toward = rotated(conjugate(orientation), to_light.xyz)[axis];
  bool visible = true;
#else
  float toward = rotated(conjugate(orientation), -centre)[axis];
  bool visible = abs(toward) > half_extents[axis];
#endif
  vec3 signs;
  signs[axis] = toward < 0.0 ? -1.0 : 1.0;
  signs[(axis + 1) % 3] = (corner & 1) == 0 ? -1.0 : 1.0;
  signs[(axis + 2) % 3] = (corner & 2) == 0 ? -1.0 : 1.0;
  tag = tag_box | uint(axis) << 28 | uint(body);
  gl_Position =
      visible ? projected(centre + rotated(orientation, signs * half_extents)) : vec4(2.0, 2.0, 2.0, 1.0);
}
