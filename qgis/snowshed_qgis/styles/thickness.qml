<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" opacity="0.85" classificationMin="0" classificationMax="3" alphaBand="-1">
      <rastershader>
        <colorrampshader colorRampType="DISCRETE" classificationMode="1" clip="0" minimumValue="0" maximumValue="3">
          <item value="0.01" color="#ffffff" alpha="0" label=""/>
          <item value="0.25" color="#e6f5b2" alpha="255" label="0.01 to 0.25 m"/>
          <item value="0.5" color="#b0e0b6" alpha="255" label="0.25 to 0.5 m"/>
          <item value="1.0" color="#63c3bf" alpha="255" label="0.5 to 1 m"/>
          <item value="1.5" color="#2b9fc2" alpha="255" label="1 to 1.5 m"/>
          <item value="2.0" color="#216bae" alpha="255" label="1.5 to 2 m"/>
          <item value="3.0" color="#253997" alpha="255" label="2 to 3 m"/>
          <item value="inf" color="#081d58" alpha="255" label="above 3 m"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
