using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Tests")]
