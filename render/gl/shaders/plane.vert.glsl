// The whole picture, once for each ground.

flat out uint tag;

void main() {
  tag = tag_plane | uint(begin.y + gl_VertexID / 3);
  int corner = gl_VertexID % 3;
  gl_Position = vec4(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
