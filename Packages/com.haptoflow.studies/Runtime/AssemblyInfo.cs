using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.SampleTests")]
