// The far side of the wall; what is nearer than that is glass (shade.frag.glsl).

flat in uint tag;
out uint seen;

void main() {
  TubeSpan s = tube_span(int(tag & tag_body), ray_through(gl_FragCoord.xy));
  if (s.entry >= s.leave || s.leaves_at_cap || s.leave < forward.w) discard;
  gl_FragDepth = window_depth(s.leave);
  seen = tag;
}
