#include "contact_golden.hpp"

#include <exception>
#include <fstream>
#include <iostream>
#include <string>

int main(int argc, char** argv) {
    if (argc != 3 || std::string(argv[1]) != "--write-golden") {
        std::cerr << "usage: haptoflow_contact_golden --write-golden Tests/Golden/contact/contact-states.json\n";
        return 2;
    }
    try {
        std::ofstream file(argv[2], std::ios::binary);
        file << haptoflow::headless::golden::fileText(haptoflow::headless::golden::goldenCases());
        file.close();
        if (!file) {
            std::cerr << argv[2] << ": cannot be written; expected a path in a folder that exists\n";
            return 3;
        }
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 4;
    }
    return 0;
}
