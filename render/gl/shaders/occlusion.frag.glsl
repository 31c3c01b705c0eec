// Ambient occlusion from the depths around a pixel (McGuire, Mara, Luebke 2012, "Scalable ambient obscurance",
// sec. 2): taps on a spiral, turned by one of 16 angles that the next pass averages out.

uniform sampler2D geometry;
out vec2 visibility_and_depth;

const int taps = 11;

vec3 position_of(ivec2 pixel, float depth) { return depth * ray_through(2.0 * vec2(pixel) + 0.5); }

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 here = texelFetch(geometry, pixel, 0);
  vec3 position = position_of(pixel, here.w);
  float reach = zenith.w;
  // Close up the reach stops growing on screen: distant taps would only cost time.
  float screen_reach = min(reach / pixel_at(here.w), 0.12 * float(extent.z));
  reach = screen_reach * pixel_at(here.w);

  int turn = (pixel.x & 3) * 4 + (pixel.y & 3);
  float phase = 6.2831853 / 16.0 * float((turn * 7) & 15);
  float occlusion = 0.0;
  for (int k = 0; k < taps; ++k) {
    float along = (float(k) + 0.5) / float(taps);
    float angle = phase + 43.98 * along;  // seven turns
    ivec2 tap = pixel + ivec2(screen_reach * along * vec2(cos(angle), sin(angle)));
    tap = clamp(tap, ivec2(0), extent.yz - 1);
    float depth = texelFetch(geometry, tap, 0).w;
    vec3 toward = position_of(tap, depth) - position;
    float squared = dot(toward, toward);
    float near = max(1.0 - squared / (reach * reach), 0.0);
    float rise = max(dot(toward, here.xyz) - 0.004 * here.w, 0.0) * inversesqrt(squared + 1e-20);
    occlusion += depth > 0.0 ? near * near * rise : 0.0;
  }
  float visibility = here.w > 0.0 ? max(1.0 - 4.6 * occlusion / float(taps), 0.0) : 1.0;
  visibility_and_depth = vec2(visibility, here.w);
}
