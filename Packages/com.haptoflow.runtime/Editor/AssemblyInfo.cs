using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.MissingLibraryTests")]
[assembly: InternalsVisibleTo("HaptoFlow.PreviewTests")]
