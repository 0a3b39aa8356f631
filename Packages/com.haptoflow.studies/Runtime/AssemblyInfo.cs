using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.Tests")]
