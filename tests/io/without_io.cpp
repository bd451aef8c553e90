// Linked with the whole mesher but its readers and writers; the linker reports what would need these.
int main() { return 0; }
