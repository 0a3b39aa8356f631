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
