// The triangles of meshes and of bodies that are drawn by triangles; all of them cast shadows.

flat out uint tag;

void main() {
  int facet = after.w + gl_VertexID / 3;
  tag = tag_facet | uint(facet);
  gl_Position = projected(texel_of(facet, gl_VertexID % 3).xyz);
}
