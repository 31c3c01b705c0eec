// The whole picture, once for each tube or ground.

flat out uint tag;

void main() {
#ifdef TUBE
  tag = tag_tube | uint(begin.y + gl_VertexID / 3);
#else
  tag = tag_plane | uint(begin.z + gl_VertexID / 3);
#endif
  int corner = gl_VertexID % 3;
  gl_Position = vec4(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
