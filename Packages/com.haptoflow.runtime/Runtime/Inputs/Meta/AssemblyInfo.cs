using System.Runtime.CompilerServices;
using UnityEngine.Scripting;

// A scene with an XR Pen does not reference this assembly, which registers the pen when it is loaded.
[assembly: AlwaysLinkAssembly]
[assembly: InternalsVisibleTo("HaptoFlow.Outputs.Meta")]
