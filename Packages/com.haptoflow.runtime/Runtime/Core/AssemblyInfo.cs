using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow")]
[assembly: InternalsVisibleTo("HaptoFlow.Editor")]
[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Preview")]
[assembly: InternalsVisibleTo("HaptoFlow.PreviewTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Studies")]
[assembly: InternalsVisibleTo("HaptoFlow.Tests")]
[assembly: InternalsVisibleTo("HaptoFlow.RepositoryTests")]
[assembly: InternalsVisibleTo("HaptoFlow.ShimTests")]
[assembly: InternalsVisibleTo("HaptoFlow.SampleTests")]
[assembly: InternalsVisibleTo("HaptoFlow.MissingLibraryTests")]
[assembly: InternalsVisibleTo("HaptoFlow.WrongLibraryTests")]
[assembly: InternalsVisibleTo("HaptoFlow.AotTests")]

namespace System.Runtime.CompilerServices
{
    /// <summary>What the compiler needs for records; Unity's profile, .NET Standard 2.1, does not have it. The
    /// assemblies that see the core's internals use this one.</summary>
    internal static class IsExternalInit
    {
    }
}
