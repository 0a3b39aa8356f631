using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.Editor")]
[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Meta")]
[assembly: InternalsVisibleTo("HaptoFlow.Tests")]
