using System.Runtime.CompilerServices;

[assembly: InternalsVisibleTo("HaptoFlow.Editor")]
[assembly: InternalsVisibleTo("HaptoFlow.InputSystem")]
[assembly: InternalsVisibleTo("HaptoFlow.Meta")]
[assembly: InternalsVisibleTo("HaptoFlow.Pens")]
[assembly: InternalsVisibleTo("HaptoFlow.Pens.LegacyInput")]
[assembly: InternalsVisibleTo("HaptoFlow.EditorTests")]
[assembly: InternalsVisibleTo("HaptoFlow.Studies")]
[assembly: InternalsVisibleTo("HaptoFlow.Tests")]
