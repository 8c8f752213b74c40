// Writes a light's index into the light index images; the packing's blending combines it with earlier ones.
flat in vec4 channels[LIDR_TARGETS];

layout(location = 0) out vec4 images[LIDR_TARGETS];

void main() { images = channels; }
