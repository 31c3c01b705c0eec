// Faces of boxes: depth comes from their own triangles.

flat in uint tag;
out uint seen;

void main() { seen = tag; }
