void shout() { std::cout << 1; }
