using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.Tests")]
[assembly: InternalsVisibleTo("HaptoFlow.RepositoryTests")]
[assembly: InternalsVisibleTo("HaptoFlow.ShimTests")]
[assembly: InternalsVisibleTo("HaptoFlow.SampleTests")]
