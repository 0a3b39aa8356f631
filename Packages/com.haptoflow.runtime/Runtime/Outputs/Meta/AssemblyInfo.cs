using UnityEngine.Scripting;

// No scene names this assembly: it adds routes to devices when it is loaded.
[assembly: AlwaysLinkAssembly]
