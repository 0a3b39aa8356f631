using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow")]
[assembly: InternalsVisibleTo("HaptoFlow.SampleScenes")]
[assembly: InternalsVisibleTo("HaptoFlow.SampleScenes.LegacyInput")]
[assembly: InternalsVisibleTo("HaptoFlow.Editor")]
[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Preview")]
[assembly: InternalsVisibleTo("HaptoFlow.Studies")]
[assembly: InternalsVisibleTo("HaptoFlow.Tests")]

namespace System.Runtime.CompilerServices
{
    /// <summary>What the compiler needs for records; Unity's profile, .NET Standard 2.1, does not have it. The
    /// assemblies that see the core's internals use this one.</summary>
    internal static class IsExternalInit
    {
    }
}
