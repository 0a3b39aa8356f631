using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.Editor")]
[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Tests")]
[assembly: InternalsVisibleTo("HaptoFlow.ShimTests")]
[assembly: InternalsVisibleTo("HaptoFlow.MissingLibraryTests")]
[assembly: InternalsVisibleTo("HaptoFlow.SampleTests")]
