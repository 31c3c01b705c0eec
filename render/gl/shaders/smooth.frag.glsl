// Averages the occlusion over the 4 x 4 pixels that hold all turns of the spiral, within one surface.

uniform sampler2D occlusion;  // with the depth
out float visibility;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(occlusion, pixel, 0).g;
  float tolerance = 0.25 * zenith.w;
  float sum = 0.0, weight = 0.0;
  for (int y = -2; y < 2; ++y) {
    for (int x = -2; x < 2; ++x) {
      ivec2 tap = clamp(pixel + ivec2(x, y), ivec2(0), extent.yz - 1);
      vec2 there = texelFetch(occlusion, tap, 0).rg;
      float w = max(1.0 - abs(there.g - depth) / tolerance, 0.001);
      sum += w * there.r;
      weight += w;
    }
  }
  visibility = sum / weight;
}
