#include "capi/handles.hpp"

namespace haptoflow::capi {

RuntimeTable& runtimes() {
    static auto& table = *new RuntimeTable("runtime");
    return table;
}

ModelTable& models() {
    static auto& table = *new ModelTable("model");
    return table;
}

GeneratorTable& generators() {
    static auto& table = *new GeneratorTable("generator");
    return table;
}

EngineTable& engines() {
    static auto& table = *new EngineTable("engine");
    return table;
}

}  // namespace haptoflow::capi
