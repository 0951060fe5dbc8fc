// line 1
// line 2
int broken(void) { return undeclaredName; }
