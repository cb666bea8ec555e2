// A canary.
