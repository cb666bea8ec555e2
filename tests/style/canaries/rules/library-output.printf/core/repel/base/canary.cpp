void shout() { printf("1"); }
