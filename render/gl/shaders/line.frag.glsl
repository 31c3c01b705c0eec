uniform sampler2D geometry;  // w: depth, negative where there is nothing

flat in float half_width;
flat in vec4 line_color;
flat in float where_hidden;
noperspective in float across;
in float depth;
out vec4 color;

void main() {
  float opacity = clamp(half_width + 0.5 - abs(across), 0.0, 1.0);
  float behind = texelFetch(geometry, ivec2(gl_FragCoord.xy), 0).w;
  if (behind > 0.0 && depth > 1.0005 * behind) opacity *= where_hidden;
  color = vec4(line_color.rgb, opacity);
}
