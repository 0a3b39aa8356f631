using UnityEngine.Scripting;

// No scene references this assembly, which registers device routes when it is loaded.
[assembly: AlwaysLinkAssembly]
