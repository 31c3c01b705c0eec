flat in uint tag;
out uint seen;

void main() {
  float depth = plane_depth(int(tag & tag_body), ray_through(gl_FragCoord.xy));
  if (depth < forward.w) discard;
  gl_FragDepth = window_depth(depth);
  seen = tag;
}
